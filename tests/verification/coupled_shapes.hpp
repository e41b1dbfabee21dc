// Round shapes for the coupled tests: circles as polygons, and rings and discs of triangles.

#pragma once

#include "fluid_solver/vector.hpp"
#include "solid_solver/mesh.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace duet::test {

/// Corners of a circle about the origin, counter-clockwise.
inline std::vector<fluid::Vec2> circle(double radius, int corners) {
    std::vector<fluid::Vec2> polygon;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        polygon.push_back(radius * fluid::Vec2{std::cos(angle), std::sin(angle)});
    }
    return polygon;
}

/// A ring about the origin, `layers` thick, with `around` nodes on each circle, or with inner = 0 a
/// disc. Each quadrilateral is cut along the diagonal that makes neighbours mirror images.
inline solid::Mesh ring_mesh(double inner, double outer, int layers, int around) {
    solid::Mesh mesh;
    const auto add_circle = [&](double r) {
        for (int i = 0; i < around; ++i) {
            const double angle = 2 * std::numbers::pi * i / around;
            mesh.node.emplace_back(r * std::cos(angle), r * std::sin(angle));
        }
    };
    const int first = inner > 0 ? 0 : 1; // the disc's innermost circle is its middle
    if (first == 1) {
        mesh.node.emplace_back(0, 0);
    }
    for (int j = first; j <= layers; ++j) {
        add_circle(inner + (outer - inner) * j / layers);
    }
    const auto node = [&](int circle, int i) {
        return static_cast<std::uint32_t>(first + (circle - first) * around + i % around);
    };
    for (int i = 0; i < around; ++i) {
        if (first == 1) {
            mesh.triangle.push_back({0, node(1, i), node(1, i + 1)});
        }
        for (int j = first; j < layers; ++j) {
            const auto a = node(j, i), b = node(j + 1, i), c = node(j + 1, i + 1),
                       d = node(j, i + 1);
            if (i % 2 == 0) {
                mesh.triangle.push_back({a, b, c});
                mesh.triangle.push_back({a, c, d});
            } else {
                mesh.triangle.push_back({a, b, d});
                mesh.triangle.push_back({b, c, d});
            }
        }
    }
    return mesh;
}

} // namespace duet::test
