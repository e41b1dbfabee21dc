// Heat flux and traction at the walls, from the particles in the layer next to them
// (docs/theory-fluid.md, "Wall estimates"). What is booked as passed through a wall is this.

#pragma once

#include "fluid_solver/boundary.hpp"
#include "fluid_solver/evaluation.hpp"
#include "fluid_solver/hydrostatics.hpp"
#include "fluid_solver/particles.hpp"

#include <cstdint>
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

    /// Loads of all wall cells in the middle of a step of `dt` seconds: from the samples of the
    /// last evaluation, the velocities after it, and the temperatures before. `body_force` by
    /// particle, m/s2, beside the buoyancy; empty without one.
    void run(const Boundary& boundary,
             const Evaluation& evaluation,
             const Particles& particles,
             const Hydrostatics& hydrostatics,
             const WallMaterial& material,
             std::span<const Vec2> body_force);

    const std::vector<WallLoad>& loads() const { return loads_; } ///< by wall cell

  private:
    /// Sums over the samples of one cell, or of a stretch of cells.
    struct Sums {
        double w = 0, wdd = 0, wddd = 0; ///< sum w, w d^2, w d^3
        Lanes rise{};                    ///< sum w d (f_wall - f_a + bend d^2)
        double wp = 0;       ///< sum w p_wall, each p_wall taken to the middle of the cell
        double wp_along = 0; ///< sum w dp/ds along the wall
        std::uint16_t compartment = 0;
        /// Adds a share of another cell's sums; this one's middle lies `ahead` of the other's.
        void add(double share, double ahead, const Sums& other);
    };
    Sums stretch(const Boundary& boundary, std::uint32_t cell, double half_width) const;

    double turn_of_wall(const Boundary& boundary, std::uint32_t cell) const;

    double spacing_;
    std::vector<Sums> sums_;
    std::vector<WallLoad> loads_;
};

} // namespace duet::fluid
