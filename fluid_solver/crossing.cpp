// No particle crosses a wall: what comes close slows down as the flow does there, what would cross
// is held off, counted and booked, and what cannot be held off ends the run
// (docs/theory-fluid.md, "Particles beside walls").

#include "fluid_solver/implementation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace duet::fluid {

namespace {

constexpr double close = 0.1; ///< of a spacing: nearer than that a particle goes by slow_approach
/// Of a spacing: what is farther behind a wall was passed by it. Half a step moves neither flow nor
/// walls by more than 0.21 spacings.
constexpr double deepest_touch = 0.25;

Vec2 normal(const Segment& s) {
    return (1 / s.length) * left(s.b - s.a);
}

} // namespace

Vec2 Boundary::place_on(const Segment& s, double along, std::span<const Vec2> before) const {
    if (s.node_a >= interface_nodes_) {
        return place_on(s, along);
    }
    return (1 - along) * before[s.node_a] + along * before[s.node_b];
}

/// On which side of a segment's line the point lies at both ends of the way tells whether it
/// crosses the line, and by their distances when; where on the segment is looked at there.
std::optional<Boundary::Crossing>
Boundary::first_crossing(Vec2 from, Vec2 to, std::span<const Vec2> before) const {
    std::optional<Crossing> first;
    double earliest = 2;
    const std::size_t cell = grid_.index(to);
    for (std::uint32_t c = candidate_start_[cell]; c < candidate_start_[cell + 1]; ++c) {
        const Face& face = faces_[candidate_[c]];
        const Vec2 x0 = from - image_shift(face), x1 = to - image_shift(face);
        for (std::uint32_t j = face.first; j < face.first + face.segments; ++j) {
            const Segment& s = segments_[j];
            const Vec2 a0 = place_on(s, 0, before), b0 = place_on(s, 1, before);
            const double start = -dot(x0 - a0, left(b0 - a0)) / norm(b0 - a0);
            const double end = -dot(x1 - s.a, normal(s));
            if (start < 0 || end >= 0) {
                continue;
            }
            const double t = start / (start - end);
            const Vec2 a = (1 - t) * a0 + t * s.a, b = (1 - t) * b0 + t * s.b;
            const double on = dot((1 - t) * x0 + t * x1 - a, b - a) / dot(b - a, b - a);
            if (t < earliest && on >= -1e-9 && on <= 1 + 1e-9) {
                earliest = t;
                const double foot = dot(x1 - s.a, s.b - s.a) / (s.length * s.length);
                first = Crossing{j, std::clamp(foot, 0.0, 1.0), -end, image_shift(face)};
            }
        }
    }
    return first;
}

std::string Boundary::name(const Segment& s) const {
    if (s.node_a >= interface_nodes_) {
        return s.wall == none ? "a wall without a name" : "wall '" + walls_[s.wall].name + "'";
    }
    for (std::size_t c = 0; c < chains_.size(); ++c) {
        const std::vector<std::uint32_t>& nodes = chains_[c].nodes;
        if (std::find(nodes.begin(), nodes.end(), s.node_a) != nodes.end()) {
            return chains_[c].name.empty() ? "chain " + std::to_string(c) + " of the interface"
                                           : "the surface of '" + chains_[c].name + "'";
        }
    }
    return "the interface";
}

void Fluid::Implementation::hold_off_walls(const HalfStep& half) {
    double wall_way = 0; // of the node that went farthest
    for (std::size_t i = 0; i < interface_before_.size(); ++i) {
        wall_way = std::max(wall_way, norm(interface_position_[i] - interface_before_[i]));
    }
    // A particle and a wall approach each other by no more than the longest way of any particle and
    // the longest of any wall. So their distances when the operators were evaluated, half a step or
    // a whole one ago, tell which particles cannot have come near.
    const double nearer = wall_way + *std::max_element(farthest_.begin(), farthest_.end());
    const double since = half.with_shift ? nearer : nearer + nearer_before_;
    const double reach = (1 + 1e-9) * (since + std::max(nearer, close * config.spacing));
    const bool known = evaluated_ && reach < evaluation_.kernel().support();
    nearer_before_ = nearer;
    held_.resize(chunks_of(particles.size()));
    for_chunks(
        particles.size(), config.threads, [&](std::size_t c, std::size_t first, std::size_t last) {
            held_[c].touches.clear();
            held_[c].escaped.reset();
            for (std::size_t a = first; a < last; ++a) {
                const WallTerms* wall = known ? evaluation_.wall(a) : nullptr;
                if (known ? wall != nullptr && wall->distance <= reach
                          : boundary_.near(particles.position(a))) {
                    hold_off(a, half, wall_way, held_[c]);
                }
            }
        });
    for (const Held& held : held_) { // in the order of the chunks, whatever thread had them
        if (held.escaped) {
            report_escape(*held.escaped, half.end);
        }
        for (const Touch& touch : held.touches) {
            book_touch(touch);
        }
    }
}

void Fluid::Implementation::hold_off(std::size_t a,
                                     const HalfStep& half,
                                     double wall_way,
                                     Held& held) {
    const Vec2 x = particles.position(a);
    const Boundary::Nearest wall = boundary_.nearest(x);
    const Vec2 gone = way(a, half.length, half.with_shift);
    if (wall.distance > std::max(norm(gone) + wall_way, close * config.spacing)) {
        return; // it cannot have been on the other side
    }
    auto crossing = boundary_.first_crossing(x - gone, x, interface_before_);
    if (!crossing && wall.distance > 0) {
        slow_approach(a, half, wall);
        return;
    }
    if (!crossing) { // it was behind the wall before
        const WallPoint foot = boundary_.at(*wall.face, wall.foot);
        const auto segment = static_cast<std::uint32_t>(foot.segment - boundary_.segments().data());
        crossing = {segment, foot.along, -wall.distance, boundary_.image_shift(*wall.face)};
    }
    const Segment& segment = boundary_.segments()[crossing->segment];
    const Vec2 n = normal(segment);
    const Vec2 moving = (1 - crossing->along) * boundary_.velocity(segment.node_a)
                        + crossing->along * boundary_.velocity(segment.node_b);
    Fields& f = particles.fields[a];
    const Touch touch{a, *crossing, std::max(0.0, dot(Vec2{f.u, f.v} - moving, n))};
    if (crossing->depth > deepest_touch * config.spacing || !put_before(a, *crossing)) {
        held.escaped = held.escaped ? held.escaped : touch;
        return;
    }
    f.u -= touch.into * n.x;
    f.v -= touch.into * n.y;
    held.touches.push_back(touch);
}

/// Between a particle at distance d and the wall the velocity across the wall falls to the wall's
/// own, so a particle on its way towards the wall slows down: with the profile linear,
/// d' = -v_n d/d0, and instead of s = v_n dt it goes d0 (1 - exp(-s/d0)) and never arrives. (Less
/// than s by s^2/(2 d0): only close to the wall that matters.)
void Fluid::Implementation::slow_approach(std::size_t a,
                                          const HalfStep& half,
                                          const Boundary::Nearest& wall) {
    if (wall.distance > close * config.spacing) {
        return;
    }
    const WallPoint foot = boundary_.at(*wall.face, wall.foot);
    const Vec2 x = particles.position(a), off = (1 / wall.distance) * (x - wall.point);
    const Vec2 wall_before = boundary_.place_on(*foot.segment, foot.along, interface_before_)
                             + boundary_.image_shift(*wall.face);
    const double before = dot(x - way(a, half.length, half.with_shift) - wall_before, off);
    if (before > wall.distance) {
        const double now = before * std::exp(-(before - wall.distance) / before);
        put(a, wall.point + now * off);
    }
}

/// Puts a particle to a tenth of a spacing before the segment that it crossed, and so before what
/// else it is then behind of; whether that can be done.
bool Fluid::Implementation::put_before(std::size_t a, const Boundary::Crossing& crossing) {
    const Segment& segment = boundary_.segments()[crossing.segment];
    Vec2 place = boundary_.place_on(segment, crossing.along) + crossing.shift, n = normal(segment);
    for (int corner = 0; corner < 3; ++corner) {
        put(a, place - clearance * config.spacing * n);
        const auto wall = boundary_.nearest(particles.position(a));
        if (wall.distance > 0) {
            return true;
        }
        place = wall.point;
        n = wall.face->normal;
    }
    return false;
}

/// What a touch took away of the particle's momentum is an impulse on the wall, and but for the
/// wall's own motion its energy is lost.
void Fluid::Implementation::book_touch(const Touch& touch) {
    const double mass = config.density * volume;
    const Segment& segment = boundary_.segments()[touch.at.segment];
    totals_.wall_hits += 1;
    totals_.wall_hit_loss += 0.5 * mass * touch.into * touch.into;
    pass(boundary_.cell_at(segment, touch.at.along), 0, mass * touch.into * normal(segment));
}

void Fluid::Implementation::report_escape(const Touch& escaped, double now) const {
    const Segment& segment = boundary_.segments()[escaped.at.segment];
    const Vec2 place = boundary_.place_on(segment, escaped.at.along);
    const Vec2 before = boundary_.place_on(segment, escaped.at.along, interface_before_);
    std::ostringstream sentence;
    sentence << "a fluid particle has crossed " << boundary_.name(segment) << " at (" << place.x
             << ", " << place.y << ") at t = " << now << " s: it came "
             << escaped.at.depth / config.spacing << " spacings behind it in half a step, in which "
             << "the wall moved by " << norm(place - before) / config.spacing
             << " spacings; shorten time.window, refine fluid.spacing, or look at what moves the "
                "wall or narrows the gap";
    throw Diverged(sentence.str());
}

} // namespace duet::fluid
