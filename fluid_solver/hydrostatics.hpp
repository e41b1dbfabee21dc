// The part of the pressure that a compartment's mean buoyancy makes. It is known, so it is added to
// what is told and left out of what is carried: only departures from it move the fluid, and the
// sound speed need not cope with it (docs/theory-fluid.md, "Pressure").

#pragma once

#include "fluid_solver/vector.hpp"

#include <cstdint>
#include <vector>

namespace duet::fluid {

/// Body force b = (T - reference) * per_kelvin of the Boussinesq fluid, split by compartment into
/// its value at the level temperature and the rest.
class Hydrostatics {
  public:
    struct Level {
        /// K, by direction: the mean over the compartment; the reference in a periodic direction,
        /// where no wall holds the mean force
        Vec2 temperature;
        Vec2 centre; ///< of the compartment's particles, where this pressure vanishes
    };

    Hydrostatics(double density, double reference, Vec2 per_kelvin)
        : density_(density), reference_(reference), per_kelvin_(per_kelvin) {}

    std::vector<Level> levels; ///< by compartment

    /// Change of the body force with the temperature, m/(s2 K).
    Vec2 per_kelvin() const { return per_kelvin_; }
    /// The whole body force, m/s2.
    Vec2 force(double temperature) const { return (temperature - reference_) * per_kelvin_; }
    /// What is left of it beside the level's.
    Vec2 departure(double temperature, std::uint16_t compartment) const {
        const Vec2 level = levels[compartment].temperature;
        return {(temperature - level.x) * per_kelvin_.x, (temperature - level.y) * per_kelvin_.y};
    }
    /// rho b_level . (x - centre), Pa.
    double pressure(Vec2 x, std::uint16_t compartment) const {
        return dot(gradient(compartment), x - levels[compartment].centre);
    }
    /// rho b_level, Pa/m.
    Vec2 gradient(std::uint16_t compartment) const {
        const Vec2 level = levels[compartment].temperature;
        return density_
               * Vec2{(level.x - reference_) * per_kelvin_.x,
                      (level.y - reference_) * per_kelvin_.y};
    }

  private:
    double density_, reference_;
    Vec2 per_kelvin_;
};

} // namespace duet::fluid
