// What the part of a particle's support that is cut off by walls adds to its sums: ghost particles
// on a lattice behind each face (docs/theory-fluid.md, "Walls").

#pragma once

#include "fluid_solver/boundary.hpp"
#include "fluid_solver/kernel.hpp"
#include "fluid_solver/lanes.hpp"
#include "fluid_solver/vector.hpp"

#include <array>
#include <vector>

namespace duet::fluid {

/// A symmetric 2 x 2 tensor by its components xx, xy, yy.
using Symmetric = std::array<double, 3>;

/// The components of a third-order tensor that is symmetric in its last two indices, by the first.
using Third = std::array<Symmetric, 2>;

inline Third operator+(Third a, const Third& b) {
    for (std::size_t l = 0; l < 2; ++l) {
        for (std::size_t jk = 0; jk < 3; ++jk) {
            a[l][jk] += b[l][jk];
        }
    }
    return a;
}

/// Sums of ghosts whose value at the wall is known. xi is the vector from the particle to the point
/// where the line to the ghost crosses the wall (on a long straight wall: to the foot point).
struct DirichletSums {
    Vec2 S;            ///< sum V gradW q
    double K = 0;      ///< sum 2 V F q
    Mat2 S_xi;         ///< sum S xi^T
    Third S_xi_xi;     ///< sum S_l xi_j xi_k, by l
    Vec2 K_xi;         ///< sum K xi
    Symmetric K_xi_xi; ///< sum K xi_j xi_k
};

/// Sums of ghosts whose slope along the wall's normal is known.
struct NeumannSums {
    Mat2 N_n;      ///< sum N n^T
    Third N_d_n_n; ///< sum 2 N_l d1 n_j n_k, by l
};

/// All that the walls add to one particle.
struct WallSums {
    bool slips = false;           ///< a wall that slips is in sight; else v has the sums of u
    DirichletSums u, v;           ///< walls where this component of the velocity is known
    NeumannSums u_slips, v_slips; ///< the others
    DirichletSums temperature;    ///< heated walls only
    NeumannSums adiabatic;        ///< the others
    Mat2 N_n;                     ///< sum N n^T over all walls, for the pressure
    Vec2 N_acceleration;          ///< sum N (a_wall . n)
    Vec2 C;                       ///< sum V gradW, for the shift
    Lanes Sx_value, Sy_value;     ///< sum S f_wall, lanes u, v, 0, T; of known slopes sum N slope
    Lanes K_value;                ///< sum K f_wall
};

class Ghosts {
  public:
    explicit Ghosts(double spacing);

    /// Adds up over all walls that a particle sees. Zero without contacts.
    void sums(const Boundary& boundary, const std::vector<Contact>& contacts, WallSums& sums) const;

    /// Whether the line from the particle to the point at x + r is cut by one of the walls it sees.
    static bool hidden(const std::vector<Contact>& contacts, Vec2 r);

    /// The fraction of the way from the particle to the point at x + r where it crosses the wall;
    /// above one if it does not.
    static double crossing(const Contact& contact, Vec2 r);

    /// Calls visit(r, d2, volume, fraction) for each ghost behind the wall of `contact` that lies
    /// closer to the particle than `support`: r from the particle to the ghost, d2 the ghost's
    /// distance behind it, `fraction` as by crossing(). A ghost belongs to the wall that the
    /// line to it crosses first; on a tie, by halves.
    template <class Visit>
    void for_each(const Contact& contact,
                  const std::vector<Contact>& all,
                  double support,
                  const Visit& visit) const {
        const double d1 = contact.distance;
        const int columns = static_cast<int>(support / lattice_) + 1;
        for (double d2 = lattice_ / 2; d1 + d2 < support; d2 += lattice_) {
            for (int i = -columns; i < columns; ++i) {
                const double along = (i + 0.5) * lattice_;
                if ((d1 + d2) * (d1 + d2) + along * along >= support * support) {
                    continue;
                }
                const Vec2 r = (d1 + d2) * contact.normal + along * contact.tangent;
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
                if (share > 0) {
                    visit(r, d2, share * volume_, fraction);
                }
            }
        }
    }

    /// Scalar sums behind an endless straight wall at distance d1, components along its normal:
    /// F0 = sum V F, F1 = sum V F d2, C = sum V gradW, N = sum V gradW (n.x_ga).
    struct Straight {
        double F0 = 0, F1 = 0, C = 0, N = 0;
    };
    Straight straight(double d1) const; ///< from the table

    /// A particle closer to a wall than this counts as this far off in the ratio d2/d1.
    double least_distance() const { return least_distance_; }

  private:
    Straight direct(double d1) const;
    bool spans(const Contact& contact, const std::vector<Contact>& all) const;
    void add_straight(const Boundary& boundary, const Contact& contact, WallSums& sums) const;
    void add_direct(const Boundary& boundary,
                    const Contact& contact,
                    const std::vector<Contact>& all,
                    WallSums& sums) const;

    Kernel kernel_;
    double lattice_, volume_, least_distance_;
    std::vector<Straight> table_;
};

} // namespace duet::fluid
