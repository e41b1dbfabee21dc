// The cavity's own walls: loops of sides, what is left of them beside leaning solids, and their
// values at a time.

#include "fluid_solver/boundary.hpp"
#include "fluid_solver/fluid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace duet::fluid {

namespace {

double signed_area(const std::vector<Vec2>& polygon) {
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    }
    return twice / 2;
}

std::string print(Vec2 x) {
    return "(" + std::to_string(x.x) + ", " + std::to_string(x.y) + ")";
}

template <class Sides>
double perimeter(const Sides& sides) {
    double length = 0;
    for (const auto& side : sides) {
        length += norm(side.b - side.a);
    }
    return length;
}

} // namespace

std::vector<Vec2> circle(Vec2 centre, double radius, double spacing) {
    const double side = std::min(2 * spacing, std::sqrt(8 * radius * 0.02 * spacing));
    const double turn = 2 * std::numbers::pi;
    const auto count = static_cast<std::size_t>(std::max(12.0, std::ceil(turn * radius / side)));
    const double angle = turn / static_cast<double>(count);
    const double equal_area = radius * std::sqrt(angle / std::sin(angle));
    std::vector<Vec2> corners;
    for (std::size_t i = 0; i < count; ++i) {
        const double phi = angle * static_cast<double>(i);
        corners.push_back(centre + equal_area * Vec2{std::cos(phi), std::sin(phi)});
    }
    return corners;
}

/// The fluid lies to the right: clockwise round the region, counter-clockwise round a hole.
void Boundary::add_loop(std::vector<Vec2> corners, bool hole) {
    if ((signed_area(corners) > 0) != hole) {
        std::reverse(corners.begin(), corners.end());
    }
    std::vector<Side>& sides = loops_.emplace_back();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        sides.push_back({corners[i], corners[(i + 1) % corners.size()], none, false});
    }
}

/// A wall that turns keeps its place only where it is a polygon round a circle about its centre:
/// each side is seen from there at a right angle, and bulges by little.
void Boundary::check_turning(const Wall& wall, const Side& side) const {
    if (!wall.rotation) {
        return;
    }
    constexpr double largest_bulge = 0.05; // of a spacing
    const Vec2 middle = 0.5 * (side.a + side.b) - wall.rotation->centre;
    const Vec2 half = 0.5 * (side.b - side.a);
    const double radius = norm(middle + half);
    if (std::abs(dot(middle, half)) > 1e-6 * radius * norm(half)
        || radius - norm(middle) > largest_bulge * spacing_) {
        throw SceneError("wall '" + wall.name + "' cannot turn about "
                         + print(wall.rotation->centre)
                         + ": it is no fine polygon round a circle about that point; take a disc, "
                           "or a velocity along the wall");
    }
}

/// Where a wall slips, one component of the velocity is known and the other one's slope.
void Boundary::check_slip(const Wall& wall, const Side& side) const {
    const Vec2 t = side.b - side.a;
    if (wall.slip && std::min(std::abs(t.x), std::abs(t.y)) > 1e-9 * norm(t)) {
        throw SceneError("wall '" + wall.name + "' slips from " + print(side.a) + " to "
                         + print(side.b)
                         + ", which is not along an axis; turn the scene, or let it not slip");
    }
}

void Boundary::assign_walls() {
    const double tolerance = 1e-6 * spacing_;
    for (std::size_t w = 0; w < walls_.size(); ++w) {
        const Wall& wall = walls_[w];
        bool found = false;
        const auto take = [&](Side& side) {
            if (side.seam) {
                throw SceneError("wall '" + wall.name + "' lies on the side from " + print(side.a)
                                 + " to " + print(side.b)
                                 + ", over which the fluid is periodic; let the wall cover "
                                   "other sides alone");
            }
            side.wall = static_cast<std::uint32_t>(w);
            found = true;
            check_turning(wall, side);
            check_slip(wall, side);
        };
        if (wall.around) {
            for (Side& side : loops_.at(*wall.around)) {
                take(side);
            }
        } else {
            for (std::vector<Side>& loop : loops_) {
                for (Side& side : loop) {
                    if (distance_to_segment(side.a, wall.from, wall.to) < tolerance
                        && distance_to_segment(side.b, wall.from, wall.to) < tolerance) {
                        take(side);
                    }
                }
            }
        }
        if (!found) {
            throw SceneError("wall '" + wall.name + "' from " + print(wall.from) + " to "
                             + print(wall.to)
                             + " covers no side of the fluid's region; let it run from corner to "
                               "corner (add corners to the region to split a side)");
        }
    }
}

/// Arc length of the place on the boundary next to x, and its loop.
double Boundary::perimeter_position(Vec2 x, std::size_t& loop) const {
    double best = 0, nearest = std::numeric_limits<double>::infinity();
    for (std::size_t l = 0; l < loops_.size(); ++l) {
        double arc = 0;
        for (const Side& side : loops_[l]) {
            const double d = distance_to_segment(x, side.a, side.b);
            const double length = norm(side.b - side.a);
            if (d < nearest) {
                nearest = d;
                loop = l;
                best = arc + std::clamp(dot(x - side.a, side.b - side.a) / length, 0.0, length);
            }
            arc += length;
        }
    }
    if (nearest > 1e-3 * spacing_) {
        throw SceneError("a chain of the interface ends at " + print(x) + ", "
                         + std::to_string(nearest)
                         + " m from the cavity's boundary; let the solid lean on a wall there, or "
                           "close the chain");
    }
    return best;
}

/// Keeps each loop from where a chain ends to where the next one starts.
void Boundary::add_walls() {
    struct End {
        double arc;
        bool chain_starts;
    };
    std::vector<std::vector<End>> ends(loops_.size());
    for (const Chain& chain : chains_) {
        if (!chain.closed) {
            for (const bool starts : {true, false}) {
                std::size_t loop = 0;
                const double arc = perimeter_position(
                    position_[starts ? chain.nodes.front() : chain.nodes.back()], loop);
                ends[loop].push_back({arc, starts});
            }
        }
    }
    for (std::size_t l = 0; l < loops_.size(); ++l) {
        std::vector<End>& e = ends[l];
        std::sort(e.begin(), e.end(), [](End p, End q) { return p.arc < q.arc; });
        for (std::size_t i = 0; i < e.size(); ++i) {
            if (e[i].chain_starts == e[(i + 1) % e.size()].chain_starts) {
                throw SceneError(
                    "the interface chains that end on the cavity's boundary overlap each other "
                    "near arc length "
                    + std::to_string(e[i].arc) + " m of the boundary");
            }
        }
        const std::size_t first_face = faces_.size();
        first_face_.push_back(first_face);
        const double whole = perimeter(loops_[l]);
        if (e.empty()) {
            keep(loops_[l], 0, whole);
        }
        for (std::size_t i = 0; i < e.size(); ++i) {
            if (!e[i].chain_starts && i + 1 < e.size()) {
                keep(loops_[l], e[i].arc, e[i + 1].arc);
            } else if (!e[i].chain_starts) {
                keep(loops_[l], e[i].arc, whole);
                keep(loops_[l], 0, e[0].arc);
            }
        }
        link_sides(first_face);
        if (l == 0 && periodic_.any()) {
            close_over_seams(first_face);
        }
    }
}

void Boundary::keep(const std::vector<Side>& loop, double from, double to) {
    double arc = 0;
    for (const Side& side : loop) {
        const double length = norm(side.b - side.a);
        const double p = std::max(from - arc, 0.0) / length;
        const double q = std::min(to - arc, length) / length;
        if (!side.seam && (q - p) * length > 1e-9 * spacing_) {
            const Vec2 t = side.b - side.a;
            add_side({p == 0 ? side.a : side.a + p * t,
                      q == 1 ? side.b : side.a + q * t,
                      side.wall,
                      false});
        }
        arc += length;
    }
}

/// One face. Where the wall's values differ from place to place its segments are as short as the
/// particles are apart.
void Boundary::add_side(const Side& side) {
    const Vec2 whole = side.b - side.a;
    const double length = norm(whole);
    bool known_temperature = false, slip = false;
    std::uint32_t pieces = 1;
    if (side.wall != none) {
        const Wall& wall = walls_[side.wall];
        known_temperature = wall.temperature.has_value();
        slip = wall.slip;
        wall_length_[side.wall] += length;
        if (!wall.velocity.is_number() || wall.rotation || !wall.heat_flux.is_number()
            || (known_temperature && !wall.temperature->is_number())) {
            pieces = static_cast<std::uint32_t>(std::ceil(length / spacing_));
        }
    }
    const auto first = static_cast<std::uint32_t>(segments_.size());
    const auto place = [&](std::uint32_t i) {
        return i == 0        ? side.a
               : i == pieces ? side.b
                             : side.a + (static_cast<double>(i) / pieces) * whole;
    };
    for (std::uint32_t i = 0; i < pieces; ++i) {
        const auto node = static_cast<std::uint32_t>(velocity_.size());
        const Vec2 a = place(i), b = place(i + 1);
        segments_.push_back({a, b, node, node + 1, side.wall, norm(b - a), 0, 0, 0});
        for (const Vec2 at : {a, b}) {
            if (side.wall != none) {
                wall_nodes_.push_back({static_cast<std::uint32_t>(velocity_.size()),
                                       at,
                                       (1 / length) * whole,
                                       side.wall});
            }
            velocity_.push_back({});
            acceleration_.push_back({});
            temperature_.push_back(0);
        }
    }
    add_face(first, pieces, known_temperature, slip);
}

/// The polygon of an arc is smooth.
void Boundary::link_sides(std::size_t first_face) {
    const std::size_t count = faces_.size() - first_face;
    for (std::size_t i = 0; i < count; ++i) {
        const Face& from = faces_[first_face + i];
        const Face& to = faces_[first_face + (i + 1) % count];
        const Segment& last = segments_[from.first + from.segments - 1];
        const Segment& next = segments_[to.first];
        if (&from != &to && norm(last.b - next.a) < 1e-9 * spacing_ && last.wall == next.wall) {
            link(last, next);
        }
    }
}

void Boundary::set_walls(double time) {
    time_ = time;
    for (const WallNode& n : wall_nodes_) {
        const Wall& wall = walls_[n.wall];
        // The walls keep their place: what would move them across themselves is left out; but a
        // polygon that stands for a circle turns as a whole, so that the fluid may turn with it.
        Vec2 velocity = dot(wall.velocity(n.place, time), n.along) * n.along;
        if (wall.rotation) {
            const double rate = wall.rotation->rate(n.place, time);
            const Vec2 arm = n.place - wall.rotation->centre;
            velocity += rate * left(arm);
            acceleration_[n.node] = -(rate * rate) * arm; // towards the centre
        }
        velocity_[n.node] = velocity;
        temperature_[n.node] = wall.temperature    ? (*wall.temperature)(n.place, time)
                               : conductivity_ > 0 ? wall.heat_flux(n.place, time) / conductivity_
                                                   : 0;
    }
}

} // namespace duet::fluid
