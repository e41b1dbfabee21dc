// The domains over which gradients are constant: edge-based smoothing domains (ES-FEM), or the
// triangles themselves (plain T3) through the same code.

#pragma once

#include "solid_solver/mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace duet::solid {

enum class Smoothing {
    edge,   ///< one domain an edge: ES-FEM (method: edge-based smoothed FEM on T3)
    element ///< one domain a triangle: plain T3
};

/// K domains, as contiguous arrays. A domain has 3 or 4 nodes; one with 3 repeats its first node
/// in the last slot with gradient and weight zero, so that loops over domains need no branch. The
/// nodes of an inner edge a -> b are a, b, the corner to its left, the corner to its right; those
/// of a single triangle go round counter-clockwise.
struct Domains {
    static constexpr std::size_t slots = 4;

    std::vector<double> area;                           ///< [K] m2, reference
    std::vector<std::array<std::uint32_t, slots>> node; ///< [K]
    std::vector<std::array<double, slots>> gradient_x;  ///< [K] 1/m, smoothed dN/dx (15)
    std::vector<std::array<double, slots>> gradient_y;  ///< [K] 1/m, smoothed dN/dy (15)
    std::vector<std::array<double, slots>> weight;      ///< [K] mean of N over the domain
    double share = 1; ///< of a triangle's area that a domain takes: 1/3 round an edge, or all
    std::vector<std::uint32_t> part; ///< [K] of the mesh; tells the material

    /// The slots that belong to node I are entry[first[I]] .. entry[first[I+1] - 1], each
    /// slots * domain + slot, in ascending order. A node sums its own in this order, so that a sum
    /// over domains has the same bits for any number of threads.
    std::vector<std::uint32_t> first; ///< [N + 1]
    std::vector<std::uint32_t> entry;

    std::size_t size() const { return area.size(); }
};

/// Domains of a mesh that check_mesh accepts. Edge domains: area sum_e A_e/3, gradient the
/// area-weighted mean of the triangles' (exact for (15) on linear triangles), weight from the mean
/// (4 T_i + 4 T_j + T_l)/9 over each sub-triangle of edge ij and centroid. An edge between two
/// parts of the mesh makes two domains, one in each: the strain jumps where the material does, and
/// a mean over both would smear it.
Domains make_domains(const Mesh& mesh, Smoothing smoothing);

/// A third of the area of the triangles round each node [N] m2: the lumped measure of (19), (25).
/// Each triangle counts `density` of its part, 1 where there is none: kg/m for a mass.
std::vector<double> nodal_area(const Mesh& mesh, const std::vector<double>& density = {});

} // namespace duet::solid
