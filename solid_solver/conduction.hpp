// The conduction matrix, assembled once: one step of a body at rest is one pass over it.

#pragma once

#include "solid_solver/smoothing.hpp"

#include <cstdint>
#include <vector>

namespace duet::solid {

/// Heat flows between pairs of nodes. K of (26) is symmetric with rows that sum to zero, so that
/// -(K T)_I = sum_J G_IJ (T_J - T_I) with the conductances G_IJ = -K_IJ: a uniform temperature
/// stays so exactly, and what one node of a pair gives the other receives, to the last bit.
class Conduction {
  public:
    /// K_IJ = sum_k A_k conductivity gradN_I . gradN_J over the domains, with the conductivity of
    /// the domain's part of the mesh. W/(m K).
    Conduction(const Domains& domains, const std::vector<double>& conductivity);

    /// out_I = T_I + factor_I (rate_I + sum_J G_IJ (T_J - T_I)) for nodes begin .. end - 1; with
    /// factor = dt/C and rate = loads this is the explicit step of (24).
    void advance(const double* temperature,
                 const double* rate,
                 const double* factor,
                 double* out,
                 std::size_t begin,
                 std::size_t end) const;

    /// out_I = sum_J G_IJ (T_J - T_I), W/m.
    void flow(const double* temperature, double* out) const;

    /// Calls visit(I, J, G_IJ) for each pair I > J.
    template <class Visit>
    void for_pairs(const Visit& visit) const {
        for (std::uint32_t i = 0; i < nodes(); ++i) {
            for (std::uint32_t j = first_[i]; j < first_[i + 1] && neighbour_[j] < i; ++j) {
                visit(i, neighbour_[j], conductance_[j]);
            }
        }
    }

    std::size_t nodes() const { return first_.size() - 1; }

  private:
    std::vector<std::uint32_t> first_;     ///< [N + 1]
    std::vector<std::uint32_t> neighbour_; ///< J, ascending in each row
    std::vector<double> conductance_;      ///< G_IJ
};

} // namespace duet::solid
