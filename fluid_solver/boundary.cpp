#include "fluid_solver/boundary.hpp"

#include "fluid_solver/fluid.hpp"
#include "fluid_solver/kernel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace duet::fluid {

double distance_to_segment(Vec2 x, Vec2 a, Vec2 b) {
    const Vec2 t = b - a;
    const double s = std::clamp(dot(x - a, t) / dot(t, t), 0.0, 1.0);
    return norm(x - a - s * t);
}

Boundary::Boundary(const Config& config,
                   const std::vector<Chain>& chains,
                   const InterfaceState& state)
    : spacing_(config.spacing), support_(support_in_spacings * config.spacing), chains_(chains),
      walls_(config.walls), conductivity_(config.conductivity), periodic_(config.periodic),
      interface_nodes_(state.position.size()), position_(state.position) {
    lower_ = upper_ = config.region[0];
    for (const Vec2 c : config.region) {
        lower_ = {std::min(lower_.x, c.x), std::min(lower_.y, c.y)};
        upper_ = {std::max(upper_.x, c.x), std::max(upper_.y, c.y)};
    }
    grid_ = CellGrid(lower_, upper_, support_, periodic_);
    add_loop(config.region, false);
    for (const std::vector<Vec2>& hole : config.holes) {
        add_loop(hole, true);
    }
    if (periodic_.any()) {
        open_seams(config);
    }
    assign_walls();
    for (const Chain& chain : chains_) {
        interface_segments_ += chain.segments();
    }
    build();
    set_values(state.velocity, std::vector<Vec2>(interface_nodes_), state.temperature);
}

void Boundary::place(const std::vector<Vec2>& positions) {
    if (positions == position_) {
        return;
    }
    for (const Vec2 x : positions) {
        if (!in_reach(x)) {
            throw Diverged("the interface has left the fluid's region at (" + std::to_string(x.x)
                           + ", " + std::to_string(x.y)
                           + "); shorten time.window, or look at what moves the solid");
        }
    }
    position_ = positions;
    build();
}

void Boundary::build() {
    segments_.clear();
    faces_.clear();
    first_face_.clear();
    cells_.clear();
    velocity_.resize(interface_nodes_);
    acceleration_.resize(interface_nodes_);
    temperature_.resize(interface_nodes_);
    wall_length_.assign(walls_.size(), 0);
    wall_nodes_.clear();
    for (const Chain& chain : chains_) {
        add_chain(chain);
    }
    add_walls();
    bend_cells();
    first_face_.push_back(faces_.size());
    for (std::size_t i = 0; periodic_.any() && i + 1 < first_face_.size(); ++i) {
        add_images(first_face_[i], first_face_[i + 1]);
    }
    register_faces();
    set_walls(time_);
}

void Boundary::add_chain(const Chain& chain) {
    const auto first = static_cast<std::uint32_t>(segments_.size());
    const auto first_face = static_cast<std::uint32_t>(faces_.size());
    first_face_.push_back(first_face);
    const auto count = static_cast<std::uint32_t>(chain.segments());
    for (std::uint32_t j = 0; j < count; ++j) {
        const std::uint32_t a = chain.nodes[j];
        const std::uint32_t b = chain.nodes[(j + 1) % chain.nodes.size()];
        segments_.push_back(
            {position_[a], position_[b], a, b, none, norm(position_[b] - position_[a]), 0, 0, 0});
    }
    // Faces end where the direction changes. (A face that runs over the first node of a closed
    // chain is cut there, which the ghost sums of neighbouring faces allow for.)
    const auto direction = [&](std::uint32_t j) {
        const Segment& s = segments_[first + j];
        return (1 / s.length) * (s.b - s.a);
    };
    std::uint32_t start = 0;
    for (std::uint32_t j = 1; j <= count; ++j) {
        if (j == count || std::abs(cross(direction(start), direction(j))) > 1e-9
            || dot(direction(start), direction(j)) < 0) {
            add_face(first + start, j - start, !chain.insulated, false);
            start = j;
        }
    }
    find_runs(first_face);
    link_cells(chain, first);
}

/// Joins the faces from `first` on into runs. A joint continues a run if it turns by less than
/// 5 degrees and bends the wall by less than 0.35 over the length of a support, so that within a
/// support the tangent lies close to the wall; no run turns by more than 60 degrees in all, so that
/// a wall that turns back shows a particle both its branches.
void Boundary::find_runs(std::uint32_t first) {
    constexpr double sharpest_joint = 5 * std::numbers::pi / 180;
    constexpr double sharpest_bend = 0.35;
    constexpr double longest_turn = std::numbers::pi / 3;
    const auto count = static_cast<std::uint32_t>(faces_.size());
    double turned = 0;
    for (std::uint32_t f = first; f < count; ++f) {
        Face& face = faces_[f];
        face.run = f;
        if (f == first) {
            continue;
        }
        const Face& before = faces_[f - 1];
        const double turn =
            std::atan2(cross(before.tangent, face.tangent), dot(before.tangent, face.tangent));
        const double bend = 2 * std::abs(turn) * support_ / (before.length + face.length);
        turned += turn;
        if (face.heated == before.heated && std::abs(turn) < sharpest_joint && bend < sharpest_bend
            && std::abs(turned) < longest_turn) {
            face.run = before.run;
            face.run_before = before.run_before + before.length;
        } else {
            turned = 0;
        }
    }
    for (std::uint32_t f = count; f-- > first;) {
        if (f + 1 < count && faces_[f + 1].run == faces_[f].run) {
            faces_[f].run_after = faces_[f + 1].run_after + faces_[f + 1].length;
        }
    }
}

void Boundary::add_face(std::uint32_t first, std::uint32_t segments, bool heated, bool slip) {
    Face face;
    face.a = segments_[first].a;
    face.b = segments_[first + segments - 1].b;
    face.length = norm(face.b - face.a);
    face.tangent = (1 / face.length) * (face.b - face.a);
    face.normal = left(face.tangent);
    face.first = first;
    face.segments = segments;
    face.heated = heated;
    face.slip = slip;
    face.run = static_cast<std::uint32_t>(faces_.size());
    for (std::uint32_t j = first; j < first + segments; ++j) {
        segments_[j].face_start = dot(segments_[j].a - face.a, face.tangent);
        add_cells(j, face);
    }
    faces_.push_back(face);
}

void Boundary::add_cells(std::uint32_t segment, const Face& face) {
    Segment& s = segments_[segment];
    s.first_cell = static_cast<std::uint32_t>(cells_.size());
    s.cells = static_cast<std::uint32_t>(
        std::max(1.0, std::ceil(s.length / (0.5 * spacing_) * (1 - 1e-9))));
    const Wall* wall = s.wall == none ? nullptr : &walls_[s.wall];
    const bool one_temperature =
        wall != nullptr && wall->temperature && wall->temperature->is_number();
    for (std::uint32_t c = 0; c < s.cells; ++c) {
        const auto index = static_cast<std::uint32_t>(cells_.size());
        const bool starts_face = segment == face.first && c == 0;
        if (!starts_face) {
            cells_.back().after = index;
        }
        cells_.push_back({segment,
                          (c + 0.5) / s.cells,
                          s.length / s.cells,
                          face.normal,
                          face.heated,
                          face.slip,
                          one_temperature,
                          starts_face ? none : index - 1,
                          none,
                          0});
    }
}

void Boundary::link_cells(const Chain& chain, std::uint32_t first) {
    const auto count = static_cast<std::uint32_t>(chain.segments());
    for (std::uint32_t j = chain.closed ? 0 : 1; j < count; ++j) {
        link(segments_[first + (j + count - 1) % count], segments_[first + j]);
    }
}

/// Across a joint that turns by less than 30 degrees the surface counts as smooth.
void Boundary::link(const Segment& from, const Segment& to) {
    const double smooth = std::cos(std::acos(-1.0) / 6);
    const std::uint32_t before = from.first_cell + from.cells - 1;
    if (dot(cells_[before].normal, cells_[to.first_cell].normal) > smooth) {
        cells_[before].after = to.first_cell;
        cells_[to.first_cell].before = before;
    }
}

/// A face takes half of the turn at each of its ends; one that ends in a corner bends on as at its
/// other end.
void Boundary::bend_cells() {
    for (const Face& face : faces_) {
        const Segment& last = segments_[face.first + face.segments - 1];
        const std::uint32_t start = segments_[face.first].first_cell;
        const std::uint32_t end = last.first_cell + last.cells;
        double turn = 0;
        int joints = 0;
        for (const std::uint32_t next : {cells_[start].before, cells_[end - 1].after}) {
            if (next != none) {
                const double across = cross(cells_[next].normal, face.normal);
                turn += std::asin(next == cells_[start].before ? across : -across);
                ++joints;
            }
        }
        for (std::uint32_t c = start; c < end && joints > 0; ++c) {
            cells_[c].curvature = -turn / (joints * face.length);
        }
    }
}

void Boundary::register_faces() {
    const double reach = support_ + 0.5 * norm(grid_.cell()) * (1 + 1e-9);
    const auto for_cells = [&](const auto& visit) {
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            const Vec2 a = faces_[f].a, b = faces_[f].b;
            const int left_column = grid_.column(std::min(a.x, b.x) - reach);
            const int right_column = grid_.column(std::max(a.x, b.x) + reach);
            const int low_row = grid_.row(std::min(a.y, b.y) - reach);
            const int high_row = grid_.row(std::max(a.y, b.y) + reach);
            for (int row = low_row; row <= high_row; ++row) {
                for (int column = left_column; column <= right_column; ++column) {
                    if (distance_to_segment(grid_.centre(column, row), a, b) <= reach) {
                        visit(grid_.index(column, row), f);
                    }
                }
            }
        }
    };
    candidate_start_.assign(grid_.size() + 1, 0);
    for_cells([&](std::size_t cell, std::uint32_t) { ++candidate_start_[cell + 1]; });
    for (std::size_t c = 0; c < grid_.size(); ++c) {
        candidate_start_[c + 1] += candidate_start_[c];
    }
    candidate_.resize(candidate_start_.back());
    cursor_.assign(candidate_start_.begin(), candidate_start_.end());
    for_cells([&](std::size_t cell, std::uint32_t f) { candidate_[cursor_[cell]++] = f; });
}

void Boundary::set_values(std::span<const Vec2> velocity,
                          std::span<const Vec2> acceleration,
                          std::span<const double> temperature) {
    std::copy(velocity.begin(), velocity.end(), velocity_.begin());
    std::copy(acceleration.begin(), acceleration.end(), acceleration_.begin());
    std::copy(temperature.begin(), temperature.end(), temperature_.begin());
    for (const Chain& chain : chains_) {
        for (const std::uint32_t node : chain.nodes) {
            if (chain.insulated) { // there the fourth value is the slope along the normal
                temperature_[node] = 0;
            }
        }
    }
}

/// The foot point lies on the nearest face of a run. Before a joint that juts out it is the joint,
/// and the tangent turns with the particle; beyond the ends of the run the end's face goes on.
void Boundary::contacts(Vec2 x, std::vector<Contact>& contacts) const {
    contacts.clear();
    const std::size_t cell = grid_.index(x);
    const std::uint32_t end = candidate_start_[cell + 1];
    for (std::uint32_t c = candidate_start_[cell]; c < end;) {
        const std::uint32_t run = faces_[candidate_[c]].run;
        Contact nearest;
        double least = support_ * support_;
        for (; c < end && faces_[candidate_[c]].run == run; ++c) {
            const Face& face = faces_[candidate_[c]];
            const Vec2 r = x - face.a;
            const double distance = -dot(r, face.normal);
            const double foot = dot(r, face.tangent);
            const double beyond = std::max({0.0, -foot, foot - face.length});
            const double square = distance * distance + beyond * beyond;
            if (square < least) {
                least = square;
                nearest = {&face, distance, foot, face.normal, face.tangent};
            }
        }
        if (nearest.face == nullptr || !(nearest.distance > 0)) {
            continue;
        }
        const Face& face = *nearest.face;
        const double foot = std::clamp(nearest.foot, 0.0, face.length);
        if (foot != nearest.foot && nearest.on_wall()) {
            nearest.foot = foot;
            nearest.distance = std::sqrt(least);
            nearest.normal = (1 / nearest.distance) * (face.a + foot * face.tangent - x);
            nearest.tangent = {nearest.normal.y, -nearest.normal.x};
        }
        contacts.push_back(nearest);
    }
}

WallPoint Boundary::at(const Face& start, double arc) const {
    const Face* on = &start;
    const int next = start.endless ? 0 : 1;
    while (arc < 0 && on->run_before > 0) {
        on -= next;
        arc += on->length;
    }
    while (arc > on->length && on->run_after > 0) {
        arc -= on->length;
        on += next;
    }
    const Face& face = *on;
    // Segments of a face are sorted by where they start; most faces have equal segments, so the
    // proportional guess is right or next to it.
    auto j = static_cast<std::uint32_t>(std::clamp(arc / face.length, 0.0, 1.0)
                                        * static_cast<double>(face.segments));
    j = std::min(j, face.segments - 1);
    while (j > 0 && arc < segments_[face.first + j].face_start) {
        --j;
    }
    while (j + 1 < face.segments && arc >= segments_[face.first + j + 1].face_start) {
        ++j;
    }
    const Segment& s = segments_[face.first + j];
    const double w = std::clamp((arc - s.face_start) / s.length, 0.0, 1.0);
    const Vec2 v = (1 - w) * velocity_[s.node_a] + w * velocity_[s.node_b];
    const double T = (1 - w) * temperature_[s.node_a] + w * temperature_[s.node_b];
    return {Lanes{v.x, v.y, 0, T},
            (1 - w) * acceleration_[s.node_a] + w * acceleration_[s.node_b],
            &s,
            w};
}

std::uint32_t Boundary::cell_at(const Segment& segment, double along) const {
    const auto c = static_cast<std::uint32_t>(along * segment.cells);
    return segment.first_cell + std::min(c, segment.cells - 1);
}

Boundary::Nearest Boundary::nearest(Vec2 x) const {
    Nearest best;
    best.distance = support_;
    double least = support_ * support_;
    const std::size_t cell = grid_.index(x);
    for (std::uint32_t c = candidate_start_[cell]; c < candidate_start_[cell + 1]; ++c) {
        const Face& face = faces_[candidate_[c]];
        const Vec2 r = x - face.a;
        const double foot = std::clamp(dot(r, face.tangent), 0.0, face.length);
        const Vec2 point = face.a + foot * face.tangent;
        const double square = dot(x - point, x - point);
        const double distance = -dot(r, face.normal);
        // At a corner two faces share the nearest point; the one whose line is farther away tells
        // on which side x lies.
        const bool tie =
            best.face != nullptr && std::abs(square - least) <= 1e-12 * support_ * support_;
        if (tie ? std::abs(distance) > std::abs(best.distance) : square < least) {
            best = {&face, distance, point, foot};
            least = tie ? least : square;
        }
    }
    if (best.face != nullptr) {
        best.distance = std::copysign(std::sqrt(least), best.distance);
    }
    return best;
}

bool Boundary::contains(Vec2 x) const {
    bool inside = false;
    const auto cross_line = [&](Vec2 a, Vec2 b) {
        if ((a.y > x.y) != (b.y > x.y) && x.x < a.x + (x.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
            inside = !inside;
        }
    };
    for (const Face& face : faces_) {
        cross_line(face.a, face.b);
    }
    for (const Side& seam : seams_) {
        cross_line(seam.a, seam.b);
    }
    return inside;
}

double Boundary::distance(Vec2 x) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Face& face : faces_) {
        least = std::min(least, distance_to_segment(x, face.a, face.b));
    }
    return least;
}

double Boundary::area() const {
    double twice = 0;
    for (const Segment& s : segments_) {
        twice -= cross(s.a, s.b);
    }
    for (const Side& seam : seams_) {
        twice -= cross(seam.a, seam.b);
    }
    return twice / 2;
}

double Boundary::speed() const {
    double largest = 0;
    for (const Vec2 v : velocity_) {
        largest = std::max(largest, norm(v));
    }
    return largest;
}

bool Boundary::heated() const {
    const auto flux = [](const Wall& wall) {
        return !wall.heat_flux.is_number() || wall.heat_flux({}, 0) != 0;
    };
    return std::any_of(faces_.begin(), faces_.end(), [](const Face& f) { return f.heated; })
           || std::any_of(walls_.begin(), walls_.end(), flux);
}

} // namespace duet::fluid
