#include "fluid_solver/operators.hpp"

#include <algorithm>
#include <cmath>

namespace duet::fluid {

void weigh(const Kernel& kernel, double volume, const Neighbours& neighbours, Weights& weights) {
    for (int i = 0; i < neighbours.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double F = volume * kernel.slope_over_r(std::sqrt(neighbours.r2[k]));
        weights.F_float[k] = static_cast<float>(F);
        weights.x_float[k] = static_cast<float>(F * neighbours.x[k]);
        weights.y_float[k] = static_cast<float>(F * neighbours.y[k]);
        weights.F[k] = weights.F_float[k];
        weights.x[k] = weights.x_float[k];
        weights.y[k] = weights.y_float[k];
    }
}

Moments moments(const Neighbours& neighbours, const Weights& weights) {
    Moments m;
    double wxx = 0, wxy = 0, wyx = 0, wyy = 0, wx = 0, wy = 0;
    double xxx = 0, xxy = 0, xyy = 0, yyy = 0, sxxx = 0, sxxy = 0, sxyy = 0, syyy = 0;
    double qxxxx = 0, qxxxy = 0, qxxyy = 0, qxyyy = 0, qyyyy = 0;
#pragma omp simd reduction(+ : wxx, wxy, wyx, wyy, wx, wy, xxx, xxy, xyy, yyy, sxxx, sxxy, sxyy,   \
                               syyy, qxxxx, qxxxy, qxxyy, qxyyy, qyyyy)
    for (int i = 0; i < neighbours.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double x = neighbours.x[k], y = neighbours.y[k], F = weights.F[k];
        const double G = F / neighbours.r2[k];
        const double xx = x * x, xy = x * y, yy = y * y;
        wx += weights.x[k];
        wy += weights.y[k];
        wxx += weights.x[k] * x;
        wxy += weights.x[k] * y;
        wyx += weights.y[k] * x;
        wyy += weights.y[k] * y;
        xxx += F * x * xx;
        xxy += F * x * xy;
        xyy += F * x * yy;
        yyy += F * y * yy;
        sxxx += G * x * xx;
        sxxy += G * x * xy;
        sxyy += G * x * yy;
        syyy += G * y * yy;
        qxxxx += G * xx * xx;
        qxxxy += G * xx * xy;
        qxxyy += G * xx * yy;
        qxyyy += G * xy * yy;
        qyyyy += G * yy * yy;
    }
    m.gradient_of_concentration = {wx, wy};
    m.w_x = {wxx, wxy, wyx, wyy};
    m.xxx = xxx, m.xxy = xxy, m.xyy = xyy, m.yyy = yyy;
    m.sxxx = sxxx, m.sxxy = sxxy, m.sxyy = sxyy, m.syyy = syyy;
    m.qxxxx = qxxxx, m.qxxxy = qxxxy, m.qxxyy = qxxyy, m.qxyyy = qxyyy, m.qyyyy = qyyyy;
    return m;
}

Mat2 correction(const Moments& m, const Mat2& walls) {
    return inverse(
        {walls.xx - m.w_x.xx, walls.xy - m.w_x.xy, walls.yx - m.w_x.yx, walls.yy - m.w_x.yy});
}

Third gradient_error(const Moments& m, const Mat2& L, const Third& walls) {
    const Symmetric x{m.xxx + walls[0][0], m.xxy + walls[0][1], m.xyy + walls[0][2]};
    const Symmetric y{m.xxy + walls[1][0], m.xyy + walls[1][1], m.yyy + walls[1][2]};
    Third A{};
    for (std::size_t jk = 0; jk < 3; ++jk) {
        A[0][jk] = L.xx * x[jk] + L.xy * y[jk];
        A[1][jk] = L.yx * x[jk] + L.yy * y[jk];
    }
    return A;
}

namespace {

double determinant3(const std::array<Symmetric, 3>& c) {
    return c[0][0] * (c[1][1] * c[2][2] - c[2][1] * c[1][2])
           - c[1][0] * (c[0][1] * c[2][2] - c[2][1] * c[0][2])
           + c[2][0] * (c[0][1] * c[1][2] - c[1][1] * c[0][2]);
}

/// Solves sum_m columns[m] b_m = right by Cramer's rule.
Symmetric solve3(const std::array<Symmetric, 3>& columns, const Symmetric& right) {
    const double d = 1 / determinant3(columns);
    return {d * determinant3({right, columns[1], columns[2]}),
            d * determinant3({columns[0], right, columns[2]}),
            d * determinant3({columns[0], columns[1], right})};
}

/// Bounds of B's eigenvalues. Beside an adiabatic wall half of the support is empty and B reaches 4
/// across the wall in a sound cloud; pulling that back would cost the order.
constexpr double least_eigenvalue = 0.2, largest_eigenvalue = 6;

/// The largest theta <= 1 for which I + theta (B - I) keeps within these bounds.
double admissible_part(const Symmetric& B) {
    const double mean = 0.5 * (B[0] + B[2]);
    const double half = 0.5 * (B[0] - B[2]);
    const double radius = std::sqrt(half * half + B[1] * B[1]);
    const double low = mean - radius, high = mean + radius;
    if (!std::isfinite(radius + mean)) {
        return 0;
    }
    double theta = 1;
    if (low < least_eigenvalue) {
        theta = std::min(theta, (1 - least_eigenvalue) / (1 - low));
    }
    if (high > largest_eigenvalue) {
        theta = std::min(theta, (largest_eigenvalue - 1) / (high - 1));
    }
    return theta;
}

} // namespace

LaplacianTensor laplacian_tensor(const Moments& m, const Third& A, const DirichletSums& walls) {
    // Column mn, row jk: -q_mnjk - s_mni A_ijk; the column of B_xy counts twice (B is symmetric).
    const auto column = [&](double factor, const Symmetric& q, double sx, double sy) {
        Symmetric c{};
        for (std::size_t jk = 0; jk < 3; ++jk) {
            c[jk] = -factor * (q[jk] + sx * A[0][jk] + sy * A[1][jk]);
        }
        return c;
    };
    const std::array<Symmetric, 3> columns{column(1, {m.qxxxx, m.qxxxy, m.qxxyy}, m.sxxx, m.sxxy),
                                           column(2, {m.qxxxy, m.qxxyy, m.qxyyy}, m.sxxy, m.sxyy),
                                           column(1, {m.qxxyy, m.qxyyy, m.qyyyy}, m.sxyy, m.syyy)};
    Symmetric right{1, 0, 1};
    for (std::size_t jk = 0; jk < 3; ++jk) {
        right[jk] +=
            0.5 * walls.K_xi_xi[jk] - 0.5 * (walls.K_xi.x * A[0][jk] + walls.K_xi.y * A[1][jk]);
    }
    LaplacianTensor t;
    const Symmetric B = solve3(columns, right);
    const double theta = admissible_part(B);
    if (theta > 0) {
        t.B = {1 + theta * (B[0] - 1), theta * B[1], 1 + theta * (B[2] - 1)};
    }
    t.limited = theta < 1;
    // E = sum 2 V F (e.B e) x - sum K xi
    t.E = {2 * (t.B[0] * m.sxxx + 2 * t.B[1] * m.sxxy + t.B[2] * m.sxyy) - walls.K_xi.x,
           2 * (t.B[0] * m.sxxy + 2 * t.B[1] * m.sxyy + t.B[2] * m.syyy) - walls.K_xi.y};
    return t;
}

} // namespace duet::fluid
