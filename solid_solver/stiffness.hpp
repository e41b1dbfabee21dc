// The tangent stiffness of a body as a sparse matrix, and its Cholesky factor.

#pragma once

#include "solid_solver/mechanics.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <array>
#include <cstdint>
#include <vector>

namespace duet::solid {

class Stiffness {
  public:
    /// Finds the pattern: a node is coupled with all nodes that it shares a domain with.
    explicit Stiffness(const Mechanics& mechanics);

    /// Weights of the parts of the matrix.
    struct Parts {
        double mass = 0;      ///< 1/s2, of the lumped mass
        double material = 1;  ///< of B^T D B
        double adiabatic = 0; ///< 1: lambda + beta^2 T0/(rho c) in D, where the body heats itself
    };
    /// Factorises mass M + sum_k A_k (material B^T D B + gradN_I . S gradN_J) at the motion and
    /// stress of the last forces of `mechanics`, with unit rows for held components. False if the
    /// matrix is not positive.
    bool factorise(const Mechanics& mechanics, const Parts& parts);

    /// x = (factored matrix)^-1 right, [N][2]; held components of `right` must be zero.
    void solve(const Eigen::VectorXd& right, Eigen::VectorXd& x) const;

  private:
    using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
    static constexpr std::size_t pairs = Domains::slots * (Domains::slots + 1) / 2;

    void add(const Mechanics& mechanics, std::size_t domain, const Parts& parts);

    Matrix matrix_;
    /// [K] where the 2 x 2 block of each pair of slots starts in the values of its two columns
    std::vector<std::array<std::array<int, 2>, pairs>> place_;
    std::vector<std::uint8_t> held_; ///< [N][2]
    Eigen::SimplicialLDLT<Matrix> factor_;
};

} // namespace duet::solid
