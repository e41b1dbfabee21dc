// Triangle meshes: what a body is made of.

#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace duet::solid {

using Point = Eigen::Vector2d;
using Triangle = std::array<std::uint32_t, 3>; ///< nodes, counter-clockwise

/// A named piece of the boundary.
struct Curve {
    std::string name;
    std::vector<std::array<std::uint32_t, 2>> edge; ///< nodes, in either order
};

struct Mesh {
    std::vector<Point> node; ///< m, reference positions
    std::vector<Triangle> triangle;
    std::vector<std::uint32_t> part = {}; ///< [triangles] index into part_name; empty: all are one
    std::vector<std::string> part_name = {}; ///< parts may be of different materials
    std::vector<Curve> curve = {};

    std::uint32_t part_of(std::size_t t) const { return part.empty() ? 0 : part[t]; }
    /// How many parts its triangles belong to; one at least.
    std::size_t parts() const {
        return part.empty() ? 1 : 1 + std::size_t{*std::max_element(part.begin(), part.end())};
    }
};

/// An edge of the mesh. `triangle[0]` lies to the left of the way from `a` to `b`; a boundary edge
/// has no `triangle[1]`, so that the body lies to its left and the outside to its right.
struct Edge {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::array<std::uint32_t, 2> triangle{none, none};
    bool boundary() const { return triangle[1] == none; }
};

/// Throws std::invalid_argument with a sentence if the mesh cannot be computed with: an index out
/// of range, a coordinate that is not finite, a triangle that is inverted or has no area, a node
/// that no triangle uses, two nodes in the same place, an edge with more than two triangles, a node
/// lying on an edge that it does not belong to (hanging), a boundary that meets itself in a node,
/// or pieces that overlap.
void check_mesh(const Mesh& mesh);

/// All edges, sorted by their nodes; of a mesh that check_mesh accepts.
std::vector<Edge> mesh_edges(const Mesh& mesh);

/// The boundary edges alone, the body to their left.
std::vector<Edge> boundary_edges(const Mesh& mesh);

double triangle_area(const Mesh& mesh, const Triangle& triangle);
double mesh_area(const Mesh& mesh);

} // namespace duet::solid
