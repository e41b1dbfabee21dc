#include "solid_solver/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace duet::solid {

namespace {

/// More cells than any memory holds; their nodes still have numbers of 32 bits.
constexpr double most_cells = 1e8;

/// The nearest number of whole cells along a length, at least `least`.
std::uint32_t cells(double length, double element_size, std::uint32_t least) {
    const double count = std::round(length / element_size);
    return std::max(least, static_cast<std::uint32_t>(std::min(count, most_cells + 1)));
}

void refuse_too_many(double count, double element_size) {
    if (count > most_cells) {
        std::ostringstream sentence;
        sentence << "An element size of " << element_size << " m makes " << count
                 << " cells, more than " << most_cells << "; make it larger.";
        throw std::invalid_argument(sentence.str());
    }
}

Point on_circle(const Point& centre, double radius, double turn) {
    const double angle = 2 * std::numbers::pi * turn;
    return centre + radius * Point(std::cos(angle), std::sin(angle));
}

} // namespace

Mesh rectangle_mesh(const Point& corner, double width, double height, double element_size) {
    if (!(width > 0 && height > 0 && element_size > 0)) {
        throw std::invalid_argument(
            "A rectangle's width, height and element size must be positive.");
    }
    const std::uint32_t nx = cells(width, element_size, 1), ny = cells(height, element_size, 1);
    refuse_too_many(static_cast<double>(nx) * ny, element_size);
    Mesh mesh;
    mesh.node.reserve((nx + 1) * (ny + 1));
    for (std::uint32_t j = 0; j <= ny; ++j) {
        for (std::uint32_t i = 0; i <= nx; ++i) {
            mesh.node.emplace_back(corner.x() + width * i / nx, corner.y() + height * j / ny);
        }
    }
    mesh.triangle.reserve(2 * nx * ny);
    for (std::uint32_t j = 0; j < ny; ++j) {
        for (std::uint32_t i = 0; i < nx; ++i) {
            const std::uint32_t a = j * (nx + 1) + i, b = a + 1, d = a + nx + 1, c = d + 1;
            if ((2 * i < nx) == (2 * j < ny)) {
                mesh.triangle.push_back({a, b, c});
                mesh.triangle.push_back({a, c, d});
            } else {
                mesh.triangle.push_back({a, b, d});
                mesh.triangle.push_back({b, c, d});
            }
        }
    }
    mesh.curve = {{"left", {}}, {"right", {}}, {"bottom", {}}, {"top", {}}};
    for (std::uint32_t j = 0; j < ny; ++j) {
        mesh.curve[0].edge.push_back({j * (nx + 1), (j + 1) * (nx + 1)});
        mesh.curve[1].edge.push_back({j * (nx + 1) + nx, (j + 1) * (nx + 1) + nx});
    }
    for (std::uint32_t i = 0; i < nx; ++i) {
        mesh.curve[2].edge.push_back({i, i + 1});
        mesh.curve[3].edge.push_back({ny * (nx + 1) + i, ny * (nx + 1) + i + 1});
    }
    return mesh;
}

Mesh disc_mesh(const Point& centre, double radius, double element_size) {
    if (!(radius > 0 && element_size > 0)) {
        throw std::invalid_argument("A disc's radius and element size must be positive.");
    }
    const std::uint32_t rings = cells(radius, element_size, 1);
    refuse_too_many(3.0 * rings * rings, element_size);
    Mesh mesh;
    mesh.node.push_back(centre);
    for (std::uint32_t r = 1; r <= rings; ++r) {
        for (std::uint32_t i = 0; i < 6 * r; ++i) {
            mesh.node.push_back(on_circle(centre, radius * r / rings, i / (6.0 * r)));
        }
    }
    // Node i of ring r, counted round; before ring r lie 1 + 6 (1 + ... + (r-1)) nodes.
    const auto node = [](std::uint32_t r, std::uint32_t i) {
        return r == 0 ? 0 : 1 + 3 * r * (r - 1) + i % (6 * r);
    };
    for (std::uint32_t r = 1; r <= rings; ++r) {
        for (std::uint32_t sixth = 0; sixth < 6; ++sixth) {
            for (std::uint32_t i = 0; i < r; ++i) {
                const std::uint32_t outer = sixth * r + i, inner = sixth * (r - 1) + i;
                mesh.triangle.push_back({node(r, outer), node(r, outer + 1), node(r - 1, inner)});
                if (i + 1 < r) {
                    mesh.triangle.push_back(
                        {node(r - 1, inner), node(r, outer + 1), node(r - 1, inner + 1)});
                }
            }
        }
    }
    mesh.curve = {{"rim", {}}};
    for (std::uint32_t i = 0; i < 6 * rings; ++i) {
        mesh.curve[0].edge.push_back({node(rings, i), node(rings, i + 1)});
    }
    return mesh;
}

Mesh ring_mesh(const Point& centre, double inner_radius, double outer_radius, double element_size) {
    if (!(inner_radius > 0 && outer_radius > inner_radius && element_size > 0)) {
        throw std::invalid_argument("A ring's radii and element size must be positive, and its "
                                    "inner radius smaller than its outer one.");
    }
    const double width = outer_radius - inner_radius;
    const std::uint32_t across = cells(width, element_size, 1);
    const std::uint32_t round =
        cells(std::numbers::pi * (inner_radius + outer_radius), element_size, 6);
    refuse_too_many(static_cast<double>(across) * round, element_size);
    // The circles are polygons, each turned by half a pitch against its neighbours: the middle of a
    // chord of one must stay within the corners of the next.
    const double thickness = width / across, half_pitch = std::numbers::pi / round;
    if (outer_radius * std::cos(half_pitch) <= outer_radius - thickness) {
        std::ostringstream sentence;
        sentence << "A ring of " << round << " elements round is too coarse for a thickness of "
                 << width << " m: the chords of its outer circle would cut the inner one; make the "
                 << "element size smaller than "
                 << (inner_radius + outer_radius) * std::sqrt(2 * thickness / outer_radius)
                 << " m.";
        throw std::invalid_argument(sentence.str());
    }
    Mesh mesh;
    for (std::uint32_t r = 0; r <= across; ++r) {
        for (std::uint32_t i = 0; i < round; ++i) {
            mesh.node.push_back(
                on_circle(centre, inner_radius + width * r / across, (i + 0.5 * (r % 2)) / round));
        }
    }
    const auto node = [&](std::uint32_t r, std::uint32_t i) { return r * round + i % round; };
    for (std::uint32_t r = 0; r < across; ++r) {
        for (std::uint32_t i = 0; i < round; ++i) {
            const std::uint32_t a = node(r, i), b = node(r, i + 1);
            const std::uint32_t d = node(r + 1, i), c = node(r + 1, i + 1);
            if (r % 2 == 0) { // the outer circle is half a pitch ahead
                mesh.triangle.push_back({a, d, b});
                mesh.triangle.push_back({b, d, c});
            } else {
                mesh.triangle.push_back({a, c, b});
                mesh.triangle.push_back({a, d, c});
            }
        }
    }
    mesh.curve = {{"inner", {}}, {"outer", {}}};
    for (std::uint32_t i = 0; i < round; ++i) {
        mesh.curve[0].edge.push_back({node(0, i), node(0, i + 1)});
        mesh.curve[1].edge.push_back({node(across, i), node(across, i + 1)});
    }
    return mesh;
}

} // namespace duet::solid
