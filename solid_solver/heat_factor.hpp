// The matrix of an implicit heat step and its Cholesky factor.

#pragma once

#include "solid_solver/heat.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <cstdint>
#include <vector>

namespace duet::solid {

class HeatFactor {
  public:
    /// Factorises C + tau (K + H), H the lumped convection, with unit rows for prescribed
    /// temperatures; does nothing if `tau` is that of the factor at hand.
    void prepare(const Heat& heat, double tau);

    /// In place, [N]: heat J/m into the nodes -> the change of their temperatures K.
    void solve(Eigen::VectorXd& nodal) const;

  private:
    double tau_ = 0;
    std::vector<std::uint32_t> prescribed_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

} // namespace duet::solid
