// What a body is: material, conditions, state at the start. Plain data.

#pragma once

#include "solid_solver/field.hpp"
#include "solid_solver/mesh.hpp"
#include "solid_solver/smoothing.hpp"

#include <optional>
#include <string>
#include <vector>

namespace duet::solid {

/// Isotropic and linear; SI units.
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
    Field temperature;      ///< K, of the surroundings
};

/// Conditions on all boundary edges of a curve of the mesh, or, without one, on those that lie on
/// the line from `from` to `to`. Fields are of the reference place and the time.
struct BoundaryCondition {
    std::string name;
    std::string curve;
    Point from = Point::Zero();
    Point to = Point::Zero();
    bool fixed_x = false;
    bool fixed_y = false;
    std::optional<Field> displacement_x; ///< m, prescribed
    std::optional<Field> displacement_y;
    std::optional<Field> velocity_x; ///< m/s, prescribed
    std::optional<Field> velocity_y;
    VectorField traction;             ///< Pa, per undeformed boundary, whatever the body's turn
    Field pressure;                   ///< Pa, along the inward normal of the deformed boundary
    std::optional<Field> temperature; ///< K
    Field heat_flux;                  ///< W/m2 into the body
    std::optional<Convection> convection;
};

enum class Motion {
    fixed,      ///< rigid and at rest: heat alone
    prescribed, ///< rigid, moved as told: heat alone
    rigid,      ///< rigid, moved by the forces on it
    deformable  ///< thermo-elastic
};

/// Place of a rigid body in time: turned by `angle` about `centre`, then shifted.
struct RigidMotion {
    Point centre = Point::Zero(); ///< m, reference place
    VectorField displacement;     ///< m, of `centre`
    Field angle;                  ///< rad, counter-clockwise
};

/// What holds a rigid body that moves by the forces on it. Springs are without force at the start.
struct Support {
    bool fixed_x = false, fixed_y = false, fixed_angle = false;
    double spring_x = 0, spring_y = 0; ///< N/m2: per metre of depth
    double spring_angle = 0;           ///< N: torque per angle and metre of depth
    std::optional<Point> pivot;        ///< m, a point that keeps its place; none: all move
};

/// A force on the node nearest to a material point.
struct PointLoad {
    std::string name;
    Point at = Point::Zero();
    VectorField force; ///< N/m
};

enum class Kinematics {
    total_lagrangian,  ///< Green-Lagrange strain of the undeformed body
    updated_lagrangian ///< Jaumann's stress rate on the present body: the paper's
};

enum class Plane {
    strain, ///< no strain out of the plane
    stress  ///< no stress out of the plane; the body is a metre thick when undeformed
};

enum class Start {
    as_given,   ///< with the displacement and velocity given
    equilibrium ///< at rest in static equilibrium with the loads at the start
};

enum class Mass {
    lumped,   ///< the paper's (19)
    corrected ///< towards the consistent one, for waves; explicit steps alone
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
    std::vector<Material> part_material; ///< of each part of the mesh; empty: `material`
    RigidMotion rigid_motion;            ///< if the motion is prescribed
    Support support;                     ///< if the motion is rigid
    Kinematics kinematics = Kinematics::total_lagrangian;
    Plane plane = Plane::strain;
    double reference_temperature = 0; ///< K, free of thermal stress; T0 of (31)
    Field initial_temperature;        ///< K
    VectorField initial_displacement; ///< m
    VectorField initial_velocity;     ///< m/s
    double heat_source = 0;           ///< W/m3
    Point body_force = Point::Zero(); ///< m/s2
    double stiffness_damping = 0;     ///< s (63)
    double mass_damping = 0;          ///< 1/s: the force -a M v on the nodes
    Mass mass = Mass::lumped;
    bool thermoelastic_heating = true; ///< (31)
    Stepping stepping = Stepping::explicit_steps;
    double implicit_worth = 30; ///< explicit steps that cost as much as an implicit one
    double implicit_step = 0;   ///< s, longest implicit step; 0: as long as the advance asked for
    Start start = Start::as_given;
    bool insulated = false; ///< no heat passes between the body and the fluid
    std::vector<BoundaryCondition> boundary;
    std::vector<PointLoad> point_load;
    int threads = 1;

    const Material& material_of(std::uint32_t part) const {
        return part_material.empty() ? material : part_material[part];
    }
    /// The material of each part of the mesh.
    std::vector<Material> materials() const {
        return part_material.empty() ? std::vector<Material>(mesh.parts(), material)
                                     : part_material;
    }
};

/// Heat per volume and degree at constant strain in the plane, J/(m3 K): rho c in plane strain. In
/// plane stress a body that heats itself also warms its own swelling out of the plane against
/// S_zz = 0: of T0 beta tr(E) in space, T0 beta E_zz = T0 beta (swelling (T - T0) - thinning
/// tr(E)), so that T0 beta^2/(lambda + 2 mu) comes to rho c and the rest to the beta of the plane.
double volumetric_capacity(const Material& material, const BodyConfig& body);

/// The boundary edges on the curve or line of `condition`. Throws std::invalid_argument naming the
/// body and the condition if there is none.
std::vector<Edge> edges_of(const BoundaryCondition& condition,
                           const BodyConfig& body,
                           const std::vector<Edge>& boundary);

} // namespace duet::solid
