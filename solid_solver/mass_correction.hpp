// What lumping the mass does to waves, undone to first order.

#pragma once

#include "solid_solver/mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace duet::solid {

/// With the consistent mass M_C of linear triangles and the lumped M_L, D = M_L - M_C couples the
/// pairs of nodes of each triangle: (D a)_I = sum_J m_IJ (a_I - a_J), m_IJ = rho A/12. Then
/// a' = (1 + M_L^-1 D) a is a = M_L^-1 f with M_C^-1 to first order in D (Christon 1999). Lumping
/// and the smoothing over edges both slow down short waves, by (kh)^2/12 together where waves run
/// along the sides of a mesh of squares; this speeds them up by just that. D has no row or column
/// sum: the momentum that the forces give stays the same.
class MassCorrection {
  public:
    /// `density` of each part of the mesh, kg/m3.
    MassCorrection(const Mesh& mesh, const std::vector<double>& density);

    /// out = (1 + M_L^-1 D) acceleration, both [N][2]; `inverse_mass` [N][2] 1/kg, zero where held.
    void apply(std::span<const double> acceleration,
               std::span<const double> inverse_mass,
               std::span<double> out,
               int threads) const;

    /// By this the square of the largest frequency grows at most: the largest eigenvalue of
    /// M_L^-1 D is that of a single triangle, 3/4.
    static constexpr double growth = 1.75;

  private:
    std::vector<std::uint32_t> first_;     ///< [N + 1]
    std::vector<std::uint32_t> neighbour_; ///< J, ascending in each row
    std::vector<double> mass_;             ///< m_IJ, kg/m
};

} // namespace duet::solid
