// The corrected gradient and the Laplacian that is exact for quadratics (docs/theory-fluid.md,
// "Laplacian"): what each particle needs to know of its surroundings, and what follows from it.
// Pairs and tensors are in single precision, eight at a time; the fields they act on are not.

#pragma once

#include "fluid_solver/ghosts.hpp"
#include "fluid_solver/kernel.hpp"
#include "fluid_solver/lanes.hpp"
#include "fluid_solver/neighbours.hpp"
#include "fluid_solver/vector.hpp"

#include <array>
#include <cstdint>

namespace duet::fluid {

/// Eight neighbours as the inner steps need them: w = V gradW = V F x, and V F. Where there are
/// fewer, F is zero and the index that of the particle itself.
struct alignas(32) PairBlock {
    float x[eight], y[eight], F[eight];
    std::uint32_t index[eight];
};

/// Sums over the fluid neighbours, x = x_ab. (What is missing follows from xx + yy = r^2.) Two
/// registers, three lanes of them unused.
struct alignas(2 * sizeof(Eight)) Moments {
    float wx = 0, wy = 0;                     ///< sum w
    float wxx = 0, wxy = 0, wyy = 0;          ///< sum w x^T
    float xxx = 0, xxy = 0, xyy = 0, yyy = 0; ///< sum V F x_l x_j x_k
    float sxxx = 0, sxxy = 0;                 ///< s_mni = sum V F x_m x_n x_i / r^2
    float qxxxx = 0, qxxxy = 0;               ///< q_mnjk = sum V F x_m x_n x_j x_k / r^2
};

/// 2 V F x_m x_n / r^2 of each neighbour, xy twice: with B they make the Laplacian's weights.
struct DirectionWeights {
    alignas(32) std::array<float, most_neighbours> xx, xy, yy;
};

/// Weights and moments of the neighbours of one particle; near.pad() has been called.
Moments weigh(const Kernel& kernel,
              float volume,
              const Neighbours& near,
              PairBlock* pairs,
              DirectionWeights& directions);

/// L = M^-1 with M = -sum w x^T + what the walls add.
Mat2 correction(const Moments& moments, const Mat2& walls);

/// The gradient's correction L, and tensor B and vector E of the Laplacian
///     lap f_a = sum 2 V F (e.B e)(f_a - f_b) - sum K (f_w - f_a) - E.grad f_a
/// of many particles, or many times over for one that has different walls for different fields.
class OperatorBatch {
  public:
    static constexpr std::size_t room = 48;

    void clear() { size_ = 0; }
    std::size_t size() const { return size_; }
    /// Away from walls.
    void add(const Moments& moments);
    /// `M` is what walls add to M; `third` what they add to sum V F x_l x_j x_k, by l.
    void add(const Moments& moments, const Mat2& M, const Third& third, const DirichletSums& walls);

    /// Solves all of them.
    void solve();

    Mat2 L(std::size_t i) const { return {L_[0][i], L_[1][i], L_[2][i], L_[3][i]}; }
    std::array<float, 3> B(std::size_t i) const { return {B_[0][i], B_[1][i], B_[2][i]}; }
    std::array<float, 2> E(std::size_t i) const { return {E_[0][i], E_[1][i]}; }
    /// A_ijk = L_il [sum V F x_l x_j x_k + walls], m: with the second derivatives H the corrected
    /// gradient errs by A_ijk H_jk / 2.
    Third A(std::size_t i) const {
        return {Symmetric{A_[0][i], A_[1][i], A_[2][i]}, Symmetric{A_[3][i], A_[4][i], A_[5][i]}};
    }
    /// Whether B was pulled back towards the unit tensor.
    bool limited(std::size_t i) const { return theta_[i] < 1; }

  private:
    using Column = std::array<float, room>;

    std::size_t size_ = 0;
    std::array<bool, room> walled_{}; ///< there is something in M_, third_ and K_
    std::array<Moments, room> rows_{};
    alignas(32) std::array<Column, 13> moments_{}; ///< the same by columns
    alignas(32) std::array<Column, 4> M_{};
    alignas(32) std::array<Column, 6> third_{};
    alignas(32) std::array<Column, 5> K_{}; ///< K xi_x, K xi_y, K xi xi
    alignas(32) std::array<Column, 4> L_{};
    alignas(32) std::array<Column, 6> A_{}; ///< by i and jk
    alignas(32) std::array<Column, 3> B_{};
    alignas(32) std::array<Column, 2> E_{};
    alignas(32) Column theta_{};
};

} // namespace duet::fluid
