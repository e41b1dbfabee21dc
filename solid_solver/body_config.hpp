// What a body is: material, conditions, state at the start. Plain data.

#pragma once

#include "solid_solver/mesh.hpp"
#include "solid_solver/smoothing.hpp"

#include <optional>
#include <string>
#include <vector>

namespace duet::solid {

/// Isotropic and linear; SI units. Plane strain.
struct Material {
    double density = 1;           ///< kg/m3
    double heat_capacity = 1;     ///< J/(kg K)
    double conductivity = 0;      ///< W/(m K)
    double youngs_modulus = 0;    ///< Pa
    double poissons_ratio = 0.3;  ///<
    double thermal_expansion = 0; ///< 1/K, linear

    double lambda() const {
        return youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio));
    }
    double mu() const { return youngs_modulus / (2 * (1 + poissons_ratio)); }
    /// Thermal stress modulus of (6): alpha (3 lambda + 2 mu), Pa/K.
    double beta() const { return thermal_expansion * (3 * lambda() + 2 * mu()); }
};

struct Convection {
    double coefficient = 0; ///< W/(m2 K)
    double temperature = 0; ///< K, of the surroundings
};

/// Conditions on all boundary edges that lie on the line from `from` to `to`.
struct BoundaryCondition {
    std::string name;
    Point from = Point::Zero();
    Point to = Point::Zero();
    bool fixed_x = false;
    bool fixed_y = false;
    Point traction = Point::Zero();    ///< Pa, per undeformed boundary, of constant direction
    std::optional<double> temperature; ///< K
    double heat_flux = 0;              ///< W/m2 into the body
    std::optional<Convection> convection;
};

enum class Motion {
    fixed,     ///< rigid and at rest: heat alone
    deformable ///< thermo-elastic, total Lagrangian
};

enum class Stepping {
    explicit_steps, ///< central difference and forward Euler within their stable step
    implicit_steps, ///< TR-BDF2, as long as asked for
    automatic       ///< whichever of the two is likely to cost less
};

struct BodyConfig {
    std::string name;
    Mesh mesh;
    Smoothing smoothing = Smoothing::edge;
    Motion motion = Motion::fixed;
    Material material;
    double reference_temperature = 0; ///< K, free of thermal stress; T0 of (31)
    double initial_temperature = 0;   ///< K
    Point initial_velocity = Point::Zero();
    double heat_source = 0;            ///< W/m3
    Point body_force = Point::Zero();  ///< m/s2
    double stiffness_damping = 0;      ///< s (63)
    double mass_damping = 0;           ///< 1/s: the force -a M v on the nodes
    bool thermoelastic_heating = true; ///< (31)
    Stepping stepping = Stepping::explicit_steps;
    double implicit_step = 0; ///< s, longest implicit step; 0: as long as the advance asked for
    std::vector<BoundaryCondition> boundary;
    int threads = 1;
};

/// The boundary edges on the line of `condition`. Throws std::invalid_argument naming the body and
/// the condition if there is none.
std::vector<Edge> edges_of(const BoundaryCondition& condition,
                           const BodyConfig& body,
                           const std::vector<Edge>& boundary);

} // namespace duet::solid
