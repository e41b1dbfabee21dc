#include "solid_solver/solid_scene.hpp"

#include "protocol/function.hpp"
#include "protocol/implicit_worth.hpp"
#include "solid_solver/mesh_file.hpp"
#include "solid_solver/shapes.hpp"

#include <algorithm>
#include <stdexcept>

namespace duet::solid {

namespace {

Point to_point(const v1::Vector& v) {
    return {v.x(), v.y()};
}

Field to_field(const v1::Function& given) {
    if (!given.has_formula() && !given.has_table()) {
        return given.number();
    }
    const protocol::Function function(given);
    return Field([function](const Point& p, double t) { return function(p.x(), p.y(), t); },
                 function.depends_on_time());
}

VectorField to_field(const v1::VectorFunction& given) {
    return {to_field(given.x()), to_field(given.y())};
}

BoundaryCondition condition_from_scene(const v1::Boundary& boundary) {
    BoundaryCondition condition;
    condition.name = boundary.name();
    condition.curve = boundary.curve();
    if (boundary.along_size() == 2) {
        condition.from = to_point(boundary.along(0));
        condition.to = to_point(boundary.along(1));
    }
    condition.fixed_x = boundary.fixed_x();
    condition.fixed_y = boundary.fixed_y();
    const auto put = [](bool given, const v1::Function& value, std::optional<Field>& place) {
        if (given) {
            place = to_field(value);
        }
    };
    put(boundary.has_displacement_x(), boundary.displacement_x(), condition.displacement_x);
    put(boundary.has_displacement_y(), boundary.displacement_y(), condition.displacement_y);
    put(boundary.has_velocity_x(), boundary.velocity_x(), condition.velocity_x);
    put(boundary.has_velocity_y(), boundary.velocity_y(), condition.velocity_y);
    put(boundary.has_temperature(), boundary.temperature(), condition.temperature);
    condition.traction = to_field(boundary.traction());
    condition.pressure = to_field(boundary.pressure());
    condition.heat_flux = to_field(boundary.heat_flux());
    if (boundary.has_convection()) {
        condition.convection = Convection{boundary.convection().coefficient(),
                                          to_field(boundary.convection().temperature())};
    }
    return condition;
}

Support support_from_scene(const v1::Support& given) {
    Support support;
    support.fixed_x = given.fixed_x();
    support.fixed_y = given.fixed_y();
    support.fixed_angle = given.fixed_angle();
    support.spring_x = given.spring_x();
    support.spring_y = given.spring_y();
    support.spring_angle = given.spring_angle();
    if (given.has_pivot()) {
        support.pivot = to_point(given.pivot());
    }
    return support;
}

Mesh mesh_from_scene(const v1::Body& body, const std::filesystem::path& folder) {
    if (!body.mesh().empty()) {
        return read_mesh_file(
            body.mesh(), {body.part().begin(), body.part().end()}, body.element_size(), folder);
    }
    if (body.has_disc()) {
        return disc_mesh(to_point(body.disc().centre()), body.disc().radius(), body.element_size());
    }
    if (body.has_ring()) {
        return ring_mesh(to_point(body.ring().centre()),
                         body.ring().inner_radius(),
                         body.ring().outer_radius(),
                         body.element_size());
    }
    return rectangle_mesh(to_point(body.rectangle().corner()),
                          body.rectangle().width(),
                          body.rectangle().height(),
                          body.element_size());
}

/// Puts in what a table of the scene gives and leaves the rest as it is.
template <class Table>
void put_material(const Table& table, Material& material) {
    const auto put = [](bool given, double value, double& place) {
        if (given) {
            place = value;
        }
    };
    put(table.has_density(), table.density(), material.density);
    put(table.has_heat_capacity(), table.heat_capacity(), material.heat_capacity);
    put(table.has_conductivity(), table.conductivity(), material.conductivity);
    put(table.has_youngs_modulus(), table.youngs_modulus(), material.youngs_modulus);
    put(table.has_poissons_ratio(), table.poissons_ratio(), material.poissons_ratio);
    put(table.has_thermal_expansion(), table.thermal_expansion(), material.thermal_expansion);
}

/// The materials in the order of the mesh's parts, if the scene gives any.
std::vector<Material> part_materials(const v1::Body& body, const BodyConfig& config) {
    if (body.material().empty()) {
        return {};
    }
    const std::vector<std::string>& names = config.mesh.part_name;
    std::vector<Material> materials(names.size(), config.material);
    for (const v1::Material& table : body.material()) {
        const auto part = std::find(names.begin(), names.end(), table.part());
        if (part == names.end()) {
            std::string known;
            for (const std::string& name : names) {
                known += name.empty() ? "" : (known.empty() ? "" : ", ") + name;
            }
            throw std::invalid_argument(
                "Body '" + body.name() + "' gives a material for the part '" + table.part()
                + "', which its mesh does not have; "
                + (known.empty() ? "its surfaces carry no names: make them physical surfaces."
                                 : "its parts are " + known + "."));
        }
        put_material(table, materials[static_cast<std::size_t>(part - names.begin())]);
    }
    return materials;
}

} // namespace

BodyConfig
config_from_scene(const v1::Body& body, unsigned threads, const std::filesystem::path& folder) {
    BodyConfig config;
    config.name = body.name();
    config.mesh = mesh_from_scene(body, folder);
    config.motion = body.motion() == v1::Body::DEFORMABLE   ? Motion::deformable
                    : body.motion() == v1::Body::PRESCRIBED ? Motion::prescribed
                    : body.motion() == v1::Body::RIGID      ? Motion::rigid
                                                            : Motion::fixed;
    config.rigid_motion = {
        to_point(body.centre()), to_field(body.displacement()), to_field(body.angle())};
    if (body.has_support()) {
        config.support = support_from_scene(body.support());
    }
    put_material(body, config.material);
    config.part_material = part_materials(body, config);
    config.initial_temperature = to_field(body.initial_temperature());
    if (body.has_reference_temperature()) {
        config.reference_temperature = body.reference_temperature();
    } else if (config.motion == Motion::deformable) {
        config.reference_temperature =
            protocol::number_of(body.initial_temperature(),
                                "initial_temperature of a body without reference_temperature");
    }
    config.initial_displacement = to_field(body.initial_displacement());
    config.initial_velocity = to_field(body.initial_velocity());
    config.heat_source = body.heat_source();
    config.body_force = to_point(body.body_force());
    config.stiffness_damping = body.stiffness_damping();
    config.mass_damping = body.mass_damping();
    config.mass = body.mass() == v1::Body::CORRECTED ? Mass::corrected : Mass::lumped;
    config.thermoelastic_heating = body.thermoelastic_heating();
    config.kinematics = body.kinematics() == v1::Body::UPDATED_LAGRANGIAN
                            ? Kinematics::updated_lagrangian
                            : Kinematics::total_lagrangian;
    config.plane = body.plane() == v1::Body::STRESS ? Plane::stress : Plane::strain;
    config.stepping = body.stepping() == v1::Body::IMPLICIT    ? Stepping::implicit_steps
                      : body.stepping() == v1::Body::AUTOMATIC ? Stepping::automatic
                                                               : Stepping::explicit_steps;
    config.implicit_worth = protocol::implicit_worth(body);
    config.implicit_step = body.implicit_step();
    config.start = body.start() == v1::Body::EQUILIBRIUM ? Start::equilibrium : Start::as_given;
    config.insulated = body.insulated();
    for (const v1::Boundary& boundary : body.boundary()) {
        config.boundary.push_back(condition_from_scene(boundary));
    }
    for (const v1::PointLoad& load : body.point_load()) {
        config.point_load.push_back({load.name(), to_point(load.at()), to_field(load.force())});
    }
    config.threads = static_cast<int>(std::max(threads, 1u));
    return config;
}

} // namespace duet::solid
