// The corrected gradient and the Laplacian that is exact for quadratics (docs/theory-fluid.md,
// "Operators"): what each particle needs to know of its surroundings, and what follows from it.

#pragma once

#include "fluid_solver/ghosts.hpp"
#include "fluid_solver/kernel.hpp"
#include "fluid_solver/neighbours.hpp"
#include "fluid_solver/vector.hpp"

#include <array>

namespace duet::fluid {

/// Weights of the neighbours of one particle: w = V gradW = V F x, rounded to float because that is
/// how the inner steps store them; every sum uses the rounded numbers, so that the gradient stays
/// exact for linear fields.
struct Weights {
    alignas(32) std::array<double, most_neighbours> x, y, F;                  ///< V F x, V F y, V F
    alignas(32) std::array<float, most_neighbours> x_float, y_float, F_float; ///< the same numbers
};

/// Sums over the fluid neighbours, x = x_ab.
struct Moments {
    Mat2 w_x;                                      ///< sum w x^T
    double xxx = 0, xxy = 0, xyy = 0, yyy = 0;     ///< sum V F x_l x_j x_k
    double sxxx = 0, sxxy = 0, sxyy = 0, syyy = 0; ///< s_mni = sum V F x_m x_n x_i / r^2
    double qxxxx = 0, qxxxy = 0, qxxyy = 0, qxyyy = 0, qyyyy = 0; ///< sum V F x x x x / r^2
    Vec2 gradient_of_concentration;                               ///< sum w
};

void weigh(const Kernel& kernel, double volume, const Neighbours& neighbours, Weights& weights);
Moments moments(const Neighbours& neighbours, const Weights& weights);

/// L = M^-1 with M = -sum w x^T + what the walls add.
Mat2 correction(const Moments& moments, const Mat2& walls);

/// A_ijk = L_il [ sum V F x_l x_j x_k + walls_ljk ]: twice the corrected gradient's error for the
/// second derivatives H_jk. Returned by i.
Third gradient_error(const Moments& moments, const Mat2& L, const Third& walls);

/// The tensor B and vector E of the Laplacian
///     lap f_a = sum 2 V F (e.B e)(f_a - f_b) - sum K (f_w - f_a) - E.grad f_a.
struct LaplacianTensor {
    Symmetric B{1, 0, 1};
    Vec2 E;
    bool limited = false; ///< B was pulled back towards the unit tensor
};

/// Solves the three equations for B, keeps its eigenvalues within bounds, and forms E.
LaplacianTensor
laplacian_tensor(const Moments& moments, const Third& A, const DirichletSums& walls);

} // namespace duet::fluid
