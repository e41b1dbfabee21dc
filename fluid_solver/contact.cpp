// Gaps between a moving interface and what lies opposite: a fluid of particles cannot follow one
// that closes, so the run ends before it does (docs/theory-fluid.md, "Gaps that close").

#include "fluid_solver/implementation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace duet::fluid {

namespace {

/// Of a spacing: a gap of one spacing holds no row of particles that has its neighbours about it,
/// and the fluid in it diverges.
constexpr double narrowest = 1.25;
constexpr double kept = 0.7; ///< of a gap that is narrow from the start
/// Of the way along the boundary from one side of a gap to the other: less lies in a notch of less
/// than 23 degrees, or between two parts that have nothing to do with each other.
constexpr double notch = 0.2;
constexpr double touching = 1e-6; ///< of a spacing: neighbours, but for rounding

} // namespace

/// Chain and arc length of each interface segment's start, and each chain's length.
Boundary::Arcs Boundary::arcs() const {
    Arcs arcs;
    std::uint32_t j = 0;
    for (std::uint32_t c = 0; c < chains_.size(); ++c) {
        double arc = 0;
        const std::uint32_t first = j;
        for (; j < first + chains_[c].segments(); ++j) {
            arcs.chain.push_back(c);
            arcs.start.push_back(arc);
            arc += segments_[j].length;
        }
        arcs.length.push_back(arc);
    }
    return arcs;
}

/// Along the boundary from the start of segment j to an arc length of a face; endless between parts
/// that do not hang together.
double Boundary::way_along(const Arcs& arcs, std::uint32_t j, const Face& face, double foot) const {
    const bool own = j < interface_segments_, other = face.first < interface_segments_;
    const std::uint32_t of = own ? j : face.first;
    const std::uint32_t c = arcs.chain[of];
    const double arc = arcs.start[of] + (own ? 0 : foot), length = arcs.length[c];
    if (own && other) {
        const double apart = std::abs(arc - arcs.start[face.first] - foot);
        return arcs.chain[face.first] != c ? std::numeric_limits<double>::infinity()
               : chains_[c].closed         ? std::min(apart, length - apart)
                                           : apart;
    }
    if (chains_[c].closed) {
        return std::numeric_limits<double>::infinity();
    }
    // From a chain that leans on the walls, by its end and straight on.
    const Vec2 on_wall = own ? face.a + foot * face.tangent : segments_[j].a;
    const Vec2 start = position_[chains_[c].nodes.front()],
               end = position_[chains_[c].nodes.back()];
    return std::min(arc + norm(grid_.shortest(on_wall - start)),
                    length - arc + norm(grid_.shortest(on_wall - end)));
}

void Boundary::find_gaps(double within, std::vector<Gap>& gaps) const {
    const Arcs arc = arcs();
    const auto part = [&](std::uint32_t segment) {
        return segment < interface_segments_ ? std::size_t{arc.chain[segment]} : chains_.size();
    };
    gaps.clear();
    for (std::uint32_t j = 0; j < segments_.size(); ++j) {
        const Vec2 x = grid_.home(segments_[j].a);
        const std::size_t cell = grid_.index(x);
        for (std::uint32_t c = candidate_start_[cell]; c < candidate_start_[cell + 1]; ++c) {
            const Face& face = faces_[candidate_[c]];
            const Vec2 r = x - face.a;
            const double foot = std::clamp(dot(r, face.tangent), 0.0, face.length);
            const double width = norm(r - foot * face.tangent);
            const bool moves = j < interface_segments_ || face.first < interface_segments_;
            if (moves && width < within && dot(r, face.normal) < 0
                && width + touching * spacing_ < notch * way_along(arc, j, face, foot)) {
                gaps.push_back(
                    {width, &segments_[j], at(face, foot).segment, part(j), part(face.first)});
            }
        }
    }
}

double& Fluid::Implementation::least_gap(const Boundary::Gap& gap) {
    return least_gaps_[std::min(gap.part, gap.opposite_part) * boundary_.parts()
                       + std::max(gap.part, gap.opposite_part)];
}

/// Between two parts that start with a narrower gap, it may close to a share of what it was.
void Fluid::Implementation::measure_gaps() {
    const double least = narrowest * config.spacing;
    least_gaps_.assign(boundary_.parts() * boundary_.parts(), least);
    boundary_.find_gaps(least / kept, gaps_);
    for (const Boundary::Gap& gap : gaps_) {
        least_gap(gap) = std::min(least_gap(gap), kept * gap.width);
    }
}

void Fluid::Implementation::check_gaps(double now) {
    if (interface_before_ == interface_position_) {
        return;
    }
    boundary_.find_gaps(narrowest * config.spacing, gaps_);
    for (const Boundary::Gap& gap : gaps_) {
        if (gap.width < least_gap(gap)) {
            const Segment& one = *gap.from;
            std::ostringstream sentence;
            sentence
                << boundary_.name(one) << " and " << boundary_.name(*gap.opposite)
                << " have come within " << gap.width / config.spacing
                << " spacings of each other at (" << one.a.x << ", " << one.a.y
                << ") at t = " << now
                << " s; there is no room for fluid between them, and bodies do not touch "
                   "in this model: end the run before, hold the body off, or refine fluid.spacing";
            throw Diverged(sentence.str());
        }
    }
}

} // namespace duet::fluid
