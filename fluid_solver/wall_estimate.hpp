// Heat flux and traction at the walls, from the particles in the layer next to them
// (docs/theory-fluid.md, "Wall estimates"). What is booked as passed through a wall is this.

#pragma once

#include "fluid_solver/boundary.hpp"
#include "fluid_solver/evaluation.hpp"
#include "fluid_solver/hydrostatics.hpp"
#include "fluid_solver/particles.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace duet::fluid {

/// Material as the wall sees it.
struct WallMaterial {
    double conductivity = 0;        ///< W/(m K)
    double kinematic_viscosity = 0; ///< m2/s
    double density = 0;             ///< kg/m3
    double heat_capacity = 0;       ///< J/(kg K)
};

/// What the fluid does to the wall at one wall cell.
struct WallLoad {
    double heat_flux = 0; ///< W/m2, from the wall into the fluid
    Vec2 traction;        ///< Pa, on the wall
    Vec2 shear;           ///< Pa, the viscous part of it
    std::uint16_t compartment = 0;
};

class WallEstimate {
  public:
    explicit WallEstimate(double spacing) : spacing_(spacing) {}

    /// Heat flux, shear and its change along the wall of all wall cells in the middle of a step,
    /// from the samples of the evaluation and what diffusion gave.
    void slopes(const Boundary& boundary,
                const Evaluation& evaluation,
                const Particles& particles,
                const WallMaterial& material);

    /// The tractions too, from the pressures and temperatures now. `body_force` by particle, m/s2,
    /// beside the buoyancy; empty without one.
    void tractions(const Boundary& boundary,
                   const Evaluation& evaluation,
                   const Particles& particles,
                   const Hydrostatics& hydrostatics,
                   const WallMaterial& material,
                   std::span<const Vec2> body_force);

    const std::vector<WallLoad>& loads() const { return loads_; } ///< by wall cell
    /// By wall cell: u_n,nn of the velocity across the wall, 1/(m s), in the row next to it.
    const std::vector<double>& bends() const { return bends_; }
    /// By wall cell: q of the temperature T_w - g d + q d^4, K/m4.
    const std::vector<double>& quartics() const { return quartics_; }

  private:
    /// Sums over the samples of one cell, or of a stretch of cells.
    struct Sums {
        Lanes w{};    ///< sum w, w d^2, w d^3, w d^2 (12 d^2 + quartic error)
        Lanes rise{}; ///< sum w d (f_wall - f_a + bend d^2)
        Lanes lap{};  ///< sum w d^3 lap u, w d^3 lap v, w d^3 (quartic error), w d^2 lap T
        std::uint16_t compartment = 0;
        /// Adds a share of another cell's sums; this one's middle lies `ahead` of the other's,
        /// which matters to no slope.
        void add(double share, double /*ahead*/, const Sums& other) {
            compartment = other.empty() ? compartment : other.compartment;
            w += share * other.w;
            rise += share * other.rise;
            lap += share * other.lap;
        }
        bool empty() const { return w[0] == 0; }
    };
    struct PressureSums { // likewise
        double w = 0;
        double wp = 0;       ///< sum w p_wall, each p_wall taken to the middle of the cell
        double wp_along = 0; ///< sum w dp/ds along the wall
        void add(double share, double ahead, const PressureSums& other) {
            w += share * other.w;
            wp += share * (other.wp + ahead * other.wp_along);
            wp_along += share * other.wp_along;
        }
        bool empty() const { return w == 0; }
    };
    /// Sums over the cells within half_width of the middle of `cell` along the wall, up to the next
    /// corner; a cell that is cut counts with the part that is inside.
    template <class Of>
    static Of stretch(const Boundary& boundary,
                      const std::vector<Of>& sums,
                      std::uint32_t cell,
                      double half_width);
    /// Over a spacing to either side, or farther where that holds no sample.
    template <class Of>
    Of sums_about(const Boundary& boundary, const std::vector<Of>& sums, std::uint32_t cell) const;

    double turn_of_wall(const Boundary& boundary, std::uint32_t cell) const;

    double bend(const Boundary& boundary, std::uint32_t cell) const;

    double spacing_;
    std::vector<Sums> sums_;
    std::vector<PressureSums> pressure_sums_;
    std::vector<WallLoad> loads_;
    std::vector<std::optional<double>> slopes_; ///< u_t,n where the samples are, 1/s
    std::vector<double> bends_, quartics_;
};

} // namespace duet::fluid
