#include "fluid_solver/ghosts.hpp"

#include <algorithm>
#include <cmath>

namespace duet::fluid {

namespace {

constexpr int table_intervals = 1024;

Symmetric square(Vec2 a) {
    return {a.x * a.x, a.x * a.y, a.y * a.y};
}

void add(Symmetric& to, double factor, const Symmetric& s) {
    for (std::size_t m = 0; m < 3; ++m) {
        to[m] += factor * s[m];
    }
}

DirichletSums& operator+=(DirichletSums& a, const DirichletSums& b) {
    a.S += b.S;
    a.K += b.K;
    a.S_xi += b.S_xi;
    a.S_xi_xi = a.S_xi_xi + b.S_xi_xi;
    a.K_xi += b.K_xi;
    add(a.K_xi_xi, 1, b.K_xi_xi);
    return a;
}

/// All ghosts behind a straight wall: S and K with the same xi.
DirichletSums with_xi(Vec2 S, double K, Vec2 xi) {
    const Symmetric xi_xi = square(xi);
    DirichletSums sums{S, K, outer(S, xi), {}, K * xi, {}};
    add(sums.S_xi_xi[0], S.x, xi_xi);
    add(sums.S_xi_xi[1], S.y, xi_xi);
    add(sums.K_xi_xi, K, xi_xi);
    return sums;
}

/// What the walls of one face know: the sums of its known values, to whom they belong, and the
/// values with what is not known left out.
void add_values(const Face& face, const DirichletSums& known, WallSums& sums) {
    if (face.knows_u()) {
        sums.u += known;
    }
    if (sums.slips && face.knows_v()) {
        sums.v += known;
    }
    if (face.heated) {
        sums.temperature += known;
    }
}
Lanes known_part(const Face& face, Lanes value) {
    value[0] = face.knows_u() ? value[0] : 0;
    value[1] = face.knows_v() ? value[1] : 0;
    value[3] = face.heated ? value[3] : 0;
    return value;
}

/// Known normal slope for the pressure, on faces of known heat flux for the temperature, and along
/// faces that slip for the velocity.
void add_slopes(const Contact& contact, const WallPoint& foot, Vec2 N, WallSums& sums) {
    const Vec2 n = contact.normal;
    const Face& face = *contact.face;
    sums.N_n += outer(N, n);
    sums.N_acceleration += dot(foot.acceleration, n) * N;
    const auto add_to = [&](NeumannSums& slopes) {
        const Symmetric n_n = square(n);
        slopes.N_n += outer(N, n);
        add(slopes.N_d_n_n[0], 2 * contact.distance * N.x, n_n);
        add(slopes.N_d_n_n[1], 2 * contact.distance * N.y, n_n);
    };
    if (!face.heated) {
        sums.Sx_value[3] += foot.value[3] * N.x;
        sums.Sy_value[3] += foot.value[3] * N.y;
        add_to(sums.adiabatic);
    }
    if (!face.knows_u()) {
        add_to(sums.u_slips);
    }
    if (!face.knows_v()) {
        add_to(sums.v_slips);
    }
}

} // namespace

Ghosts::Ghosts(double spacing)
    : kernel_(support_in_spacings * spacing), lattice_(spacing / 3), volume_(lattice_ * lattice_),
      least_distance_(0.25 * spacing) {
    for (int i = 0; i <= table_intervals; ++i) {
        table_.push_back(direct(kernel_.support() * i / table_intervals));
    }
}

double Ghosts::crossing(const Contact& contact, Vec2 r) {
    const double behind = dot(r, contact.normal) - contact.distance;
    if (behind <= 0) {
        return 2;
    }
    const double fraction = contact.distance / (contact.distance + behind);
    const double ahead = fraction * dot(r, contact.tangent);
    const double slack = 1e-9 * (contact.distance + behind);
    return ahead >= -contact.before() - slack && ahead <= contact.after() + slack ? fraction : 2;
}

Ghosts::Straight Ghosts::direct(double d1) const {
    Straight s;
    const double R = kernel_.support();
    for (double d2 = lattice_ / 2; d1 + d2 < R; d2 += lattice_) {
        for (double along = lattice_ / 2; along < R; along += lattice_) {
            const double r = std::hypot(d1 + d2, along);
            if (r < R) {
                const double VF =
                    2 * volume_ * kernel_.slope_over_r(r); // on either side of the foot
                s.F0 += VF;
                s.F1 += VF * d2;
                s.C -= VF * (d1 + d2);
                s.N -= VF * (d1 + d2) * (d1 + d2);
            }
        }
    }
    return s;
}

Ghosts::Straight Ghosts::straight(double d1) const {
    const double scaled = d1 / kernel_.support() * table_intervals;
    const auto i = std::min(static_cast<std::size_t>(scaled), std::size_t{table_intervals - 1});
    const double w = scaled - static_cast<double>(i);
    const Straight &a = table_[i], &b = table_[i + 1];
    return {(1 - w) * a.F0 + w * b.F0,
            (1 - w) * a.F1 + w * b.F1,
            (1 - w) * a.C + w * b.C,
            (1 - w) * a.N + w * b.N};
}

bool Ghosts::spans(const Contact& contact, const std::vector<Contact>& all) const {
    // The wall must cut right through the support, and no other may stand before it: one that looks
    // the other way (the far wall of a channel) does not.
    const double R = kernel_.support();
    const double half_chord = std::sqrt(R * R - contact.distance * contact.distance);
    if (contact.before() < half_chord || contact.after() < half_chord) {
        return false;
    }
    return std::all_of(all.begin(), all.end(), [&](const Contact& other) {
        return &other == &contact || dot(other.normal, contact.normal) < -0.999;
    });
}

void Ghosts::add_straight(const Boundary& boundary, const Contact& contact, WallSums& sums) const {
    const double d1 = contact.distance;
    const Vec2 n = contact.normal;
    const Straight s = straight(d1);
    const double least = std::max(d1, least_distance_);
    const double S = s.C + (s.N - s.C * d1) / least; // with q = 1 + d2/max(d1, 0.25 dx)
    const double K = 2 * (s.F0 + s.F1 / least);
    const WallPoint wall = boundary.at(*contact.face, contact.foot);
    const Lanes value = known_part(*contact.face, wall.value);
    add_values(*contact.face, with_xi(S * n, K, d1 * n), sums);
    sums.Sx_value += (S * n.x) * value;
    sums.Sy_value += (S * n.y) * value;
    sums.K_value += K * value;
    add_slopes(contact, wall, s.N * n, sums);
    sums.C += s.C * n;
}

namespace {

/// Ghosts of one row behind a wall, at r = y n + s t: sums of V F s^k over those that belong to the
/// wall, and of V F and V F s times the wall's values where their lines cross it.
struct Row {
    double m0 = 0, m1 = 0, m2 = 0, m3 = 0;
    Lanes value{}, value_s{};
};

/// Adds what a row gives to the sums of known values, in the contact's frame (n, t): q gradW and
/// 2 V F q times powers of xi = (d1, g s), g = d1/y.
struct FrameSums {
    Vec2 S, K_xi;
    double K = 0;
    Mat2 S_xi;
    Third S_xi_xi{};
    Symmetric K_xi_xi{};

    void add(const Row& row, double q, double y, double d1) {
        const double g = d1 / y;
        const double k0 = 2 * q * row.m0, k1 = 2 * q * g * row.m1, k2 = 2 * q * g * g * row.m2;
        K += k0;
        K_xi += {d1 * k0, k1};
        K_xi_xi[0] += d1 * d1 * k0;
        K_xi_xi[1] += d1 * k1;
        K_xi_xi[2] += k2;
        // gradW = -V F (y, s)
        const double n0 = -q * y * row.m0, n1 = -q * y * g * row.m1, n2 = -q * y * g * g * row.m2;
        const double t0 = -q * row.m1, t1 = -q * g * row.m2, t2 = -q * g * g * row.m3;
        S += {n0, t0};
        S_xi += {d1 * n0, n1, d1 * t0, t1};
        duet::fluid::add(S_xi_xi[0], 1, {d1 * d1 * n0, d1 * n1, n2});
        duet::fluid::add(S_xi_xi[1], 1, {d1 * d1 * t0, d1 * t1, t2});
    }
};

/// From the frame (n, t) to (x, y).
Vec2 turned(Vec2 a, const Contact& contact) {
    return a.x * contact.normal + a.y * contact.tangent;
}
Symmetric turned(const Symmetric& a, const Contact& contact) {
    const Vec2 n = contact.normal, t = contact.tangent;
    return {a[0] * n.x * n.x + 2 * a[1] * n.x * t.x + a[2] * t.x * t.x,
            a[0] * n.x * n.y + a[1] * (n.x * t.y + n.y * t.x) + a[2] * t.x * t.y,
            a[0] * n.y * n.y + 2 * a[1] * n.y * t.y + a[2] * t.y * t.y};
}

DirichletSums turned(const FrameSums& in_frame, const Contact& contact) {
    DirichletSums sums{};
    const Vec2 n = contact.normal, t = contact.tangent;
    sums.S += turned(in_frame.S, contact);
    sums.K += in_frame.K;
    sums.S_xi += outer(n, turned(Vec2{in_frame.S_xi.xx, in_frame.S_xi.xy}, contact));
    sums.S_xi += outer(t, turned(Vec2{in_frame.S_xi.yx, in_frame.S_xi.yy}, contact));
    const Symmetric along_n = turned(in_frame.S_xi_xi[0], contact);
    const Symmetric along_t = turned(in_frame.S_xi_xi[1], contact);
    add(sums.S_xi_xi[0], n.x, along_n);
    add(sums.S_xi_xi[0], t.x, along_t);
    add(sums.S_xi_xi[1], n.y, along_n);
    add(sums.S_xi_xi[1], t.y, along_t);
    sums.K_xi += turned(in_frame.K_xi, contact);
    add(sums.K_xi_xi, 1, turned(in_frame.K_xi_xi, contact));
    return sums;
}

/// Most ghosts of a row: 2 (R / (dx/3) + 1).
constexpr int most_columns = 20;
using Columns = std::array<double, most_columns>;

/// Takes from the shares of a row's ghosts, at (y, s), those whose lines cross `other` before the
/// face of `own`; on a tie, half.
void give_away(
    const Contact& own, const Contact& other, double y, const Columns& s, Columns& share) {
    const Vec2 n = own.normal, t = own.tangent;
    const double ny = dot(other.normal, n) * y, nt = dot(other.normal, t);
    const double ty = dot(other.tangent, n) * y, tt = dot(other.tangent, t);
    const double fraction = own.distance / y, distance = other.distance;
    const double before = other.before(), after = other.after();
#pragma omp simd
    for (std::size_t i = 0; i < most_columns; ++i) {
        const double reach = ny + nt * s[i]; // along the other's normal
        const double theirs = distance / reach;
        const double ahead = theirs * (ty + tt * s[i]), slack = 1e-9 * reach;
        const bool crosses =
            (reach > distance) & (ahead >= -before - slack) & (ahead <= after + slack);
        const double kept = theirs < fraction - 1e-9 ? 0 : (theirs < fraction + 1e-9 ? 0.5 : 1);
        share[i] *= crosses ? kept : 1;
    }
}

} // namespace

/// Row by row: only the ghosts' share and V F differ along a row, all else follows from its sums.
void Ghosts::add_direct(const Boundary& boundary,
                        const Contact& contact,
                        const std::vector<Contact>& all,
                        WallSums& sums) const {
    const double R = kernel_.support(), d1 = contact.distance;
    const double least = std::max(d1, least_distance_);
    const double before = contact.before(), after = contact.after();
    const Face& face = *contact.face;
    Columns s, share, VF;
    for (std::size_t i = 0; i < most_columns; ++i) {
        s[i] = (static_cast<double>(i) - most_columns / 2 + 0.5) * lattice_;
    }
    // One segment's values are linear along it.
    const bool linear = face.segments == 1 && face.run_before == 0 && face.run_after == 0;
    const Lanes at_start = boundary.at(face, 0).value;
    const Lanes slope = (1 / face.length) * (boundary.at(face, face.length).value - at_start);
    const Lanes at_foot = at_start + contact.foot * slope;
    FrameSums in_frame;
    Vec2 N;
    Lanes value_n{}, value_t{}, K_value{};
    for (double d2 = lattice_ / 2; d1 + d2 < R; d2 += lattice_) {
        const double y = d1 + d2, g = d1 / y, slack = 1e-9 * y;
#pragma omp simd
        for (std::size_t i = 0; i < most_columns; ++i) {
            const double square = y * y + s[i] * s[i], ahead = g * s[i];
            const bool mine =
                (square < R * R) & (ahead >= -before - slack) & (ahead <= after + slack);
            share[i] = mine ? 1 : 0;
            VF[i] = volume_ * kernel_.slope_over_r(std::sqrt(square));
        }
        for (const Contact& other : all) {
            if (&other != &contact) {
                give_away(contact, other, y, s, share);
            }
        }
        double m0 = 0, m1 = 0, m2 = 0, m3 = 0;
#pragma omp simd reduction(+ : m0, m1, m2, m3)
        for (std::size_t i = 0; i < most_columns; ++i) {
            const double w = share[i] * VF[i], w_s = w * s[i], w_ss = w_s * s[i];
            m0 += w;
            m1 += w_s;
            m2 += w_ss;
            m3 += w_ss * s[i];
        }
        Row row{m0, m1, m2, m3, {}, {}};
        if (linear) {
            row.value = row.m0 * at_foot + g * row.m1 * slope;
            row.value_s = row.m1 * at_foot + g * row.m2 * slope;
        } else {
            for (std::size_t i = 0; i < most_columns; ++i) {
                const double w = share[i] * VF[i];
                if (w != 0) {
                    const Lanes value = boundary.at(face, contact.foot + g * s[i]).value;
                    row.value += w * value;
                    row.value_s += w * s[i] * value;
                }
            }
        }
        const double q = 1 + d2 / least;
        in_frame.add(row, q, y, d1);
        value_n -= q * y * row.value;
        value_t -= q * row.value_s;
        K_value += 2 * q * row.value;
        const Vec2 gradW{-y * row.m0, -row.m1};
        N += y * gradW;
        sums.C += turned(gradW, contact);
    }
    add_values(face, turned(in_frame, contact), sums);
    sums.Sx_value += known_part(face, contact.normal.x * value_n + contact.tangent.x * value_t);
    sums.Sy_value += known_part(face, contact.normal.y * value_n + contact.tangent.y * value_t);
    sums.K_value += known_part(face, K_value);
    add_slopes(contact, boundary.at(face, contact.foot), turned(N, contact), sums);
}

void Ghosts::sums(const Boundary& boundary,
                  const std::vector<Contact>& contacts,
                  WallSums& sums) const {
    sums = WallSums{};
    sums.slips = std::any_of(contacts.begin(), contacts.end(), [](const Contact& contact) {
        return contact.face->slip;
    });
    for (const Contact& contact : contacts) {
        if (spans(contact, contacts)) {
            add_straight(boundary, contact, sums);
        } else {
            add_direct(boundary, contact, contacts, sums);
        }
    }
}

bool Ghosts::hidden(const std::vector<Contact>& contacts, Vec2 r) {
    return std::any_of(contacts.begin(), contacts.end(), [&](const Contact& contact) {
        return crossing(contact, r) <= 1;
    });
}

} // namespace duet::fluid
