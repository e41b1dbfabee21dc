// Periodic regions: the sides that are no walls, walls that go on over them, and the images of what
// stands near them.

#include "fluid_solver/boundary.hpp"
#include "fluid_solver/fluid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace duet::fluid {

namespace {

/// A particle must not see another one twice, nor a wall's neighbourhood reach round the period.
constexpr double shortest_period = 6; // spacings

} // namespace

/// Takes the walls off the sides across the periodic directions.
void Boundary::open_seams(const Config& config) {
    const double tolerance = 1e-6 * spacing_;
    const Vec2 size = upper_ - lower_;
    const auto on = [&](double from, double to, double line) {
        return std::abs(from - line) < tolerance && std::abs(to - line) < tolerance;
    };
    for (Side& side : loops_[0]) {
        const bool across_x = on(side.a.x, side.b.x, lower_.x) || on(side.a.x, side.b.x, upper_.x);
        const bool across_y = on(side.a.y, side.b.y, lower_.y) || on(side.a.y, side.b.y, upper_.y);
        if (!across_x && !across_y) {
            throw SceneError("a periodic region must be a rectangle along the axes");
        }
        side.seam = (periodic_.x && across_x) || (periodic_.y && across_y);
        if (side.seam) {
            seams_.push_back(side);
        }
    }
    for (const auto& [repeats, length] :
         {std::pair{periodic_.x, size.x}, std::pair{periodic_.y, size.y}}) {
        if (repeats && length < shortest_period * spacing_ * (1 - 1e-9)) {
            throw SceneError("a period of " + std::to_string(length)
                             + " m is shorter than six spacings of " + std::to_string(spacing_)
                             + " m; refine the spacing");
        }
    }
    for (const std::vector<Vec2>& hole : config.holes) {
        check_clear_of_seams(hole, "a hole");
    }
    for (const Chain& chain : chains_) {
        for (const std::uint32_t node : chain.nodes) {
            check_clear_of_seams({&position_[node], 1}, "a body");
        }
    }
}

void Boundary::check_clear_of_seams(std::span<const Vec2> places, const std::string& what) const {
    const double least = 1e-6 * spacing_;
    for (const Vec2 x : places) {
        const bool clear_x = x.x > lower_.x + least && x.x < upper_.x - least;
        const bool clear_y = x.y > lower_.y + least && x.y < upper_.y - least;
        if ((periodic_.x && !clear_x) || (periodic_.y && !clear_y)) {
            throw SceneError(what + " reaches the side over which the fluid is periodic at ("
                             + std::to_string(x.x) + ", " + std::to_string(x.y)
                             + "); move it off, or take another period of the fluid as the "
                               "region");
        }
    }
}

/// A wall that is one face from seam to seam goes on where it began: it has no ends. Where two
/// faces of one wall meet over a seam, their cells follow one another.
void Boundary::close_over_seams(std::size_t first_face) {
    for (std::size_t f = first_face; f < faces_.size(); ++f) {
        for (std::size_t g = first_face; g < faces_.size(); ++g) {
            const Vec2 way = faces_[g].a - faces_[f].b;
            const Segment& last = segments_[faces_[f].first + faces_[f].segments - 1];
            const Segment& next = segments_[faces_[g].first];
            if (norm(way) < spacing_ || norm(grid_.shortest(way)) > 1e-9 * spacing_
                || last.wall != next.wall) {
                continue;
            }
            link(last, next);
            if (f == g) {
                faces_[f].endless = true;
                faces_[f].run_before = faces_[f].run_after =
                    std::numeric_limits<double>::infinity();
            }
        }
    }
}

/// What stands within a support of a periodic side is seen over it: adds to the faces from
/// `first_face` to before `end`, one chain's or one loop's, their images one period away. A body
/// may have travelled over the side: its home is the period in which its middle lies.
void Boundary::add_images(std::size_t first_face, std::size_t end) {
    if (first_face == end) {
        return;
    }
    Vec2 low = faces_[first_face].a, high = low;
    for (std::size_t f = first_face; f < end; ++f) {
        for (const Vec2 x : {faces_[f].a, faces_[f].b}) {
            low = {std::min(low.x, x.x), std::min(low.y, x.y)};
            high = {std::max(high.x, x.x), std::max(high.y, x.y)};
        }
    }
    const Vec2 period = grid_.period(), middle = 0.5 * (low + high);
    const int beside_x = periodic_.x ? 1 : 0, beside_y = periodic_.y ? 1 : 0;
    const double home_x = periodic_.x ? std::floor((middle.x - lower_.x) / period.x) : 0;
    const double home_y = periodic_.y ? std::floor((middle.y - lower_.y) / period.y) : 0;
    for (int j = -beside_y; j <= beside_y; ++j) {
        for (int i = -beside_x; i <= beside_x; ++i) {
            const Vec2 shift{(i - home_x) * period.x, (j - home_y) * period.y};
            const bool in_sight =
                low.x + shift.x < upper_.x + support_ && high.x + shift.x > lower_.x - support_
                && low.y + shift.y < upper_.y + support_ && high.y + shift.y > lower_.y - support_;
            if (shift == Vec2{} || !in_sight) {
                continue;
            }
            for (std::size_t f = first_face; f < end; ++f) {
                if (faces_[f].endless) { // seen whole from every place of the region
                    continue;
                }
                Face image = faces_[f];
                image.a += shift;
                image.b += shift;
                image.run =
                    static_cast<std::uint32_t>(faces_.size() - (f - std::size_t{image.run}));
                faces_.push_back(image);
            }
        }
    }
}

/// Whether a node of the interface is not lost: within a support of the region, in a periodic
/// direction anywhere.
bool Boundary::in_reach(Vec2 x) const {
    const auto near = [&](bool repeats, double place, double from, double to) {
        return repeats ? std::isfinite(place) : place >= from - support_ && place <= to + support_;
    };
    return near(periodic_.x, x.x, lower_.x, upper_.x) && near(periodic_.y, x.y, lower_.y, upper_.y);
}

} // namespace duet::fluid
