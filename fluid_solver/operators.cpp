#include "fluid_solver/operators.hpp"

#include <cmath>
#include <cstddef>

namespace duet::fluid {

Moments weigh(const Kernel& kernel,
              float volume,
              const Neighbours& near,
              PairBlock* pairs,
              DirectionWeights& directions) {
    const auto inverse = static_cast<float>(1 / kernel.support());
    const float scale = volume * static_cast<float>(kernel.slope_over_r(0));
    const std::size_t blocks = near.eights();
    // In two loops, each with as many sums as there are registers for.
    Eight wx{}, wy{}, sxxx{}, sxxy{}, qxxxx{}, qxxxy{};
    for (std::size_t block = 0; block < blocks; ++block) {
        const Eight x = load_eight(&near.x[block * eight]), y = load_eight(&near.y[block * eight]);
        const Eight r2 = x * x + y * y, per_r = inverse_root(r2), ratio = per_r * per_r;
        const Eight s = 1 - r2 * per_r * inverse;
        const Eight F = s > 0 ? scale * s * s * s : Eight{};
        const Eight Fx = F * x, Fy = F * y;
        PairBlock& out = pairs[block];
        store(out.x, Fx);
        store(out.y, Fy);
        store(out.F, F);
        std::memcpy(out.index, &near.index[block * eight], sizeof out.index);
        const Eight Gx = Fx * ratio, Gy = Fy * ratio;
        const Eight Gxx = Gx * x, Gxy = Gx * y;
        store(&directions.xx[block * eight], 2 * Gxx);
        store(&directions.xy[block * eight], 4 * Gxy);
        store(&directions.yy[block * eight], 2 * Gy * y);
        wx += Fx;
        wy += Fy;
        sxxx += Gxx * x;
        sxxy += Gxx * y;
        qxxxx += Gxx * (x * x);
        qxxxy += Gxx * (x * y);
    }
    Eight wxx{}, wxy{}, wyy{}, xxx{}, xxy{}, xyy{}, yyy{};
    for (std::size_t block = 0; block < blocks; ++block) {
        const Eight x = load_eight(&near.x[block * eight]), y = load_eight(&near.y[block * eight]);
        const Eight Fxx = load_eight(pairs[block].x) * x, Fy = load_eight(pairs[block].y);
        const Eight Fxy = Fy * x, Fyy = Fy * y;
        wxx += Fxx;
        wxy += Fxy;
        wyy += Fyy;
        xxx += Fxx * x;
        xxy += Fxx * y;
        xyy += Fxy * y;
        yyy += Fyy * y;
    }
    const Eight sums[2] = {lane_sums(wx, wy, wxx, wxy, wyy, xxx, xxy, xyy),
                           lane_sums(yyy, sxxx, sxxy, qxxxx, qxxxy, Eight{}, Eight{}, Eight{})};
    Moments m;
    static_assert(sizeof m == sizeof sums);
    std::memcpy(&m, sums, sizeof m);
    return m;
}

Mat2 correction(const Moments& m, const Mat2& walls) {
    return inverse({walls.xx - static_cast<double>(m.wxx),
                    walls.xy - static_cast<double>(m.wxy),
                    walls.yx - static_cast<double>(m.wxy),
                    walls.yy - static_cast<double>(m.wyy)});
}

void OperatorBatch::add(const Moments& m) {
    if (walled_[size_]) {
        add(m, {}, {}, {});
        walled_[size_ - 1] = false;
    } else {
        rows_[size_++] = m;
    }
}

void OperatorBatch::add(const Moments& m,
                        const Mat2& M,
                        const Third& third,
                        const DirichletSums& walls) {
    rows_[size_] = m;
    walled_[size_] = true;
    const std::size_t i = size_++;
    const auto put = [&](auto& columns, std::initializer_list<double> wall_values) {
        std::size_t k = 0;
        for (const double value : wall_values) {
            columns[k++][i] = static_cast<float>(value);
        }
    };
    put(M_, {M.xx, M.xy, M.yx, M.yy});
    put(third_, {third[0][0], third[0][1], third[0][2], third[1][0], third[1][1], third[1][2]});
    put(K_, {walls.K_xi.x, walls.K_xi.y, walls.K_xi_xi[0], walls.K_xi_xi[1], walls.K_xi_xi[2]});
}

namespace {

/// Bounds of B's eigenvalues. Beside an adiabatic wall half of the support is empty and B reaches 4
/// across the wall in a sound cloud; pulling that back would cost the order.
constexpr float least_eigenvalue = 0.2F, largest_eigenvalue = 6;

/// The largest theta <= 1 for which I + theta (B - I) keeps within these bounds; 0 if B is none.
inline float admissible_part(float Bxx, float Bxy, float Byy) {
    const float mean = 0.5F * (Bxx + Byy), half = 0.5F * (Bxx - Byy);
    const float radius = std::sqrt(half * half + Bxy * Bxy);
    const float low = mean - radius, high = mean + radius;
    const float from_low = low < least_eigenvalue ? (1 - least_eigenvalue) / (1 - low) : 1;
    const float from_high = high > largest_eigenvalue ? (largest_eigenvalue - 1) / (high - 1) : 1;
    const float theta = from_low < from_high ? from_low : from_high;
    return mean + radius < 1e30F ? theta : 0; // false for NaN
}

} // namespace

/// With A_ijk = L_il [ sum V F x_l x_j x_k + walls_ljk ], twice the corrected gradient's error for
/// the second derivatives H_jk, the three equations for B (jk = xx, xy, yy) are
///     sum_mn B_mn [-q_mnjk - s_mni A_ijk] = delta_jk + (K xi_j xi_k - K xi_i A_ijk)/2.
/// Column mn of the matrix; that of B_xy counts twice, because B is symmetric. By Cramer's rule.
void OperatorBatch::solve() {
    for (std::size_t i = 0; i < size_; i += eight) {
        for (std::size_t half = 0; half < 2; ++half) {
            Eight rows[eight];
            for (std::size_t k = 0; k < eight; ++k) {
                std::memcpy(&rows[k],
                            reinterpret_cast<const std::byte*>(&rows_[i + k])
                                + half * sizeof rows[k],
                            sizeof rows[k]);
            }
            transpose(rows);
            for (std::size_t k = 0; k < eight && half * eight + k < moments_.size(); ++k) {
                store(&moments_[half * eight + k][i], rows[k]);
            }
        }
    }
    const auto& [wx, wy, wxx, wxy, wyy, xxx, xxy, xyy, yyy, sxxx, sxxy, qxxxx, qxxxy] = moments_;
    const std::size_t whole = (size_ + eight - 1) / eight * eight; // what fills it up is not read
#pragma omp simd
    for (std::size_t i = 0; i < whole; ++i) {
        // L = M^-1
        const float Mxx = M_[0][i] - wxx[i], Mxy = M_[1][i] - wxy[i];
        const float Myx = M_[2][i] - wxy[i], Myy = M_[3][i] - wyy[i];
        const float d = 1 / (Mxx * Myy - Mxy * Myx);
        const float Lxx = d * Myy, Lxy = -d * Mxy, Lyx = -d * Myx, Lyy = d * Mxx;
        // A, by i and jk
        const float x0 = xxx[i] + third_[0][i], x1 = xxy[i] + third_[1][i],
                    x2 = xyy[i] + third_[2][i];
        const float y0 = xxy[i] + third_[3][i], y1 = xyy[i] + third_[4][i],
                    y2 = yyy[i] + third_[5][i];
        const float Ax0 = Lxx * x0 + Lxy * y0, Ay0 = Lyx * x0 + Lyy * y0;
        const float Ax1 = Lxx * x1 + Lxy * y1, Ay1 = Lyx * x1 + Lyy * y1;
        const float Ax2 = Lxx * x2 + Lxy * y2, Ay2 = Lyx * x2 + Lyy * y2;
        // s and q; traces: s_xxi + s_yyi = sum w_i, q_xxjk + q_yyjk = sum w_j x_k
        const float s0 = sxxx[i], s1 = sxxy[i], s2 = wx[i] - sxxx[i], s3 = wy[i] - sxxy[i];
        const float q0 = qxxxx[i], q1 = qxxxy[i], q2 = wxx[i] - q0, q3 = wxy[i] - q1,
                    q4 = wyy[i] - q2;
        const float a0 = -(q0 + s0 * Ax0 + s1 * Ay0), a1 = -(q1 + s0 * Ax1 + s1 * Ay1),
                    a2 = -(q2 + s0 * Ax2 + s1 * Ay2);
        const float b0 = -2 * (q1 + s1 * Ax0 + s2 * Ay0), b1 = -2 * (q2 + s1 * Ax1 + s2 * Ay1),
                    b2 = -2 * (q3 + s1 * Ax2 + s2 * Ay2);
        const float c0 = -(q2 + s2 * Ax0 + s3 * Ay0), c1 = -(q3 + s2 * Ax1 + s3 * Ay1),
                    c2 = -(q4 + s2 * Ax2 + s3 * Ay2);
        const float Kx = K_[0][i], Ky = K_[1][i];
        const float r0 = 1 + 0.5F * (K_[2][i] - Kx * Ax0 - Ky * Ay0),
                    r1 = 0.5F * (K_[3][i] - Kx * Ax1 - Ky * Ay1),
                    r2 = 1 + 0.5F * (K_[4][i] - Kx * Ax2 - Ky * Ay2);
        // Cofactors: b x c, c x a, a x b
        const float u0 = b1 * c2 - b2 * c1, u1 = b2 * c0 - b0 * c2, u2 = b0 * c1 - b1 * c0;
        const float v0 = c1 * a2 - c2 * a1, v1 = c2 * a0 - c0 * a2, v2 = c0 * a1 - c1 * a0;
        const float w0 = a1 * b2 - a2 * b1, w1 = a2 * b0 - a0 * b2, w2 = a0 * b1 - a1 * b0;
        const float e = 1 / (a0 * u0 + a1 * u1 + a2 * u2);
        const float Bxx = e * (r0 * u0 + r1 * u1 + r2 * u2);
        const float Bxy = e * (r0 * v0 + r1 * v1 + r2 * v2);
        const float Byy = e * (r0 * w0 + r1 * w1 + r2 * w2);
        const float theta = admissible_part(Bxx, Bxy, Byy);
        const bool sound = theta > 0; // else B may be no number at all
        const float Txx = sound ? 1 + theta * (Bxx - 1) : 1;
        const float Txy = sound ? theta * Bxy : 0;
        const float Tyy = sound ? 1 + theta * (Byy - 1) : 1;
        // E = sum 2 V F (e.B e) x - sum K xi
        E_[0][i] = 2 * (Txx * s0 + 2 * Txy * s1 + Tyy * s2) - Kx;
        E_[1][i] = 2 * (Txx * s1 + 2 * Txy * s2 + Tyy * s3) - Ky;
        B_[0][i] = Txx;
        B_[1][i] = Txy;
        B_[2][i] = Tyy;
        L_[0][i] = Lxx;
        L_[1][i] = Lxy;
        L_[2][i] = Lyx;
        L_[3][i] = Lyy;
        A_[0][i] = Ax0;
        A_[1][i] = Ax1;
        A_[2][i] = Ax2;
        A_[3][i] = Ay0;
        A_[4][i] = Ay1;
        A_[5][i] = Ay2;
        theta_[i] = theta;
    }
}

} // namespace duet::fluid
