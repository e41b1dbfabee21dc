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

/// One ghost, or all behind a straight wall: S and K with the same xi.
void add(DirichletSums& sums, Vec2 S, double K, Vec2 xi) {
    const Symmetric xi_xi = square(xi);
    sums.S += S;
    sums.K += K;
    sums.S_xi += outer(S, xi);
    add(sums.S_xi_xi[0], S.x, xi_xi);
    add(sums.S_xi_xi[1], S.y, xi_xi);
    sums.K_xi += K * xi;
    add(sums.K_xi_xi, K, xi_xi);
}

/// Known wall values for velocity and, on heated faces, temperature.
void add_values(
    const Face& face, const WallPoint& wall, Vec2 S, double K, Vec2 xi, WallSums& sums) {
    add(sums.velocity, S, K, xi);
    Lanes value = wall.value;
    if (face.heated) {
        add(sums.temperature, S, K, xi);
    } else {
        value[3] = 0;
    }
    sums.Sx_value += S.x * value;
    sums.Sy_value += S.y * value;
    sums.K_value += K * value;
}

/// Known normal slope for the pressure and, on adiabatic faces, the temperature.
void add_slopes(const Contact& contact, Vec2 acceleration, Vec2 N, WallSums& sums) {
    const Vec2 n = contact.face->normal;
    sums.N_n += outer(N, n);
    sums.N_acceleration += dot(acceleration, n) * N;
    if (!contact.face->heated) {
        const Symmetric n_n = square(n);
        sums.adiabatic.N_n += outer(N, n);
        add(sums.adiabatic.N_d_n_n[0], 2 * contact.distance * N.x, n_n);
        add(sums.adiabatic.N_d_n_n[1], 2 * contact.distance * N.y, n_n);
    }
}

/// The fraction of the way from the particle to the point at r where it crosses the face; above one
/// if it does not.
double crossing(const Contact& contact, Vec2 r) {
    const double behind = dot(r, contact.face->normal) - contact.distance;
    if (behind <= 0) {
        return 2;
    }
    const double fraction = contact.distance / (contact.distance + behind);
    const double arc = contact.foot + fraction * dot(r, contact.face->tangent);
    const double slack = 1e-9 * (contact.distance + behind);
    return arc >= -slack && arc <= contact.face->length + slack ? fraction : 2;
}

} // namespace

Ghosts::Ghosts(double spacing)
    : kernel_(support_in_spacings * spacing), lattice_(spacing / 3), volume_(lattice_ * lattice_),
      least_distance_(0.25 * spacing) {
    for (int i = 0; i <= table_intervals; ++i) {
        table_.push_back(direct(kernel_.support() * i / table_intervals));
    }
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
    // The face must cut right through the support, and no other face may stand before it: one that
    // looks the other way (the far wall of a channel) does not.
    const double R = kernel_.support();
    const double half_chord = std::sqrt(R * R - contact.distance * contact.distance);
    if (contact.foot < half_chord || contact.foot + half_chord > contact.face->length) {
        return false;
    }
    return std::all_of(all.begin(), all.end(), [&](const Contact& other) {
        return &other == &contact || dot(other.face->normal, contact.face->normal) < -0.999;
    });
}

void Ghosts::add_straight(const Boundary& boundary, const Contact& contact, WallSums& sums) const {
    const double d1 = contact.distance;
    const Vec2 n = contact.face->normal;
    const Straight s = straight(d1);
    const double least = std::max(d1, least_distance_);
    const double S = s.C + (s.N - s.C * d1) / least; // with q = 1 + d2/max(d1, 0.25 dx)
    const double K = 2 * (s.F0 + s.F1 / least);
    const WallPoint wall = boundary.at(*contact.face, contact.foot);
    add_values(*contact.face, wall, S * n, K, d1 * n, sums);
    add_slopes(contact, wall.acceleration, s.N * n, sums);
    sums.C += s.C * n;
}

void Ghosts::add_direct(Vec2 x,
                        const Boundary& boundary,
                        const Contact& contact,
                        const std::vector<Contact>& all,
                        WallSums& sums) const {
    const Face& face = *contact.face;
    const double R = kernel_.support(), d1 = contact.distance;
    const double least = std::max(d1, least_distance_);
    const int columns = static_cast<int>(R / lattice_) + 1;
    Vec2 N;
    for (double d2 = lattice_ / 2; d1 + d2 < R; d2 += lattice_) {
        for (int i = -columns; i < columns; ++i) {
            const double along = (i + 0.5) * lattice_;
            const double square = (d1 + d2) * (d1 + d2) + along * along;
            if (square >= R * R) {
                continue;
            }
            // The ghost belongs to the face that the line to it crosses first; on a tie, by halves.
            const Vec2 r = (d1 + d2) * face.normal + along * face.tangent;
            const double fraction = crossing(contact, r);
            double share = fraction > 1 ? 0 : 1;
            for (const Contact& other : all) {
                const double theirs = &other == &contact ? 2 : crossing(other, r);
                if (theirs < fraction - 1e-9) {
                    share = 0;
                } else if (theirs < fraction + 1e-9) {
                    share *= 0.5;
                }
            }
            if (share == 0) {
                continue;
            }
            const double VF = share * volume_ * kernel_.slope_over_r(std::sqrt(square));
            const double q = 1 + d2 / least;
            const Vec2 gradW = -VF * r;
            const Vec2 xi = fraction * r;
            const WallPoint wall = boundary.at(face, dot(x + xi - face.a, face.tangent));
            add_values(face, wall, q * gradW, 2 * VF * q, xi, sums);
            N += (d1 + d2) * gradW;
            sums.C += gradW;
        }
    }
    add_slopes(contact, boundary.at(face, contact.foot).acceleration, N, sums);
}

void Ghosts::sums(Vec2 x,
                  const Boundary& boundary,
                  const std::vector<Contact>& contacts,
                  WallSums& sums) const {
    sums = WallSums{};
    for (const Contact& contact : contacts) {
        if (spans(contact, contacts)) {
            add_straight(boundary, contact, sums);
        } else {
            add_direct(x, boundary, contact, contacts, sums);
        }
    }
}

bool Ghosts::hidden(const std::vector<Contact>& contacts, Vec2 r) {
    return std::any_of(contacts.begin(), contacts.end(), [&](const Contact& contact) {
        return crossing(contact, r) <= 1;
    });
}

} // namespace duet::fluid
