// What is booked in a step: heat, impulse and work through the walls.

#include "fluid_solver/implementation.hpp"

namespace duet::fluid {

Vec2 Fluid::Implementation::momentum() const {
    const double m = config.density * volume;
    return m * sum([&](std::size_t a) {
               return Vec2{particles.fields[a].u, particles.fields[a].v};
           });
}

/// Where nothing stands in the fluid, body forces alone change its momentum. Gradients that are
/// corrected one particle at a time keep it but for their error; what they gave or took goes back
/// to all particles alike.
void Fluid::Implementation::close_momentum() {
    const Vec2 missing = initial_momentum_ + totals_.impulse_from_body_force - momentum();
    const double mass = config.density * volume * static_cast<double>(particles.size());
    for_particles(particles.size(), config.threads, [&](std::size_t a) {
        particles.fields[a].u += missing.x / mass;
        particles.fields[a].v += missing.y / mass;
    });
    totals_.closure_momentum_abs += norm(missing);
}

WallMaterial Fluid::Implementation::wall_material() const {
    return {config.conductivity, config.kinematic_viscosity, config.density, config.heat_capacity};
}

/// Estimates the slopes at the walls, and with them corrects what the operators make of the rows of
/// particles next to these.
void Fluid::Implementation::estimate_slopes() {
    wall_estimate_.slopes(boundary_, evaluation_, particles, wall_material());
    evaluation_.correct_samples(
        wall_estimate_.bends(), wall_estimate_.quartics(), diffusivity(), smoothness());
}

/// Books what passes through each wall cell in this step.
void Fluid::Implementation::book(double dt) {
    wall_estimate_.tractions(
        boundary_, evaluation_, particles, hydrostatics_, wall_material(), given_force_);
    passed_heat_.assign(compartments, 0);
    for (std::size_t c = 0; c < boundary_.cells().size(); ++c) {
        const double length = boundary_.cells()[c].length;
        const WallLoad& load = wall_estimate_.loads()[c];
        const double heat = heat_ ? dt * length * load.heat_flux : 0;
        passed_heat_[load.compartment] += heat;
        pass(static_cast<std::uint32_t>(c), heat, (dt * length) * load.traction);
        totals_.viscous_loss -= dt * length * dot(load.shear, wall_velocity(c));
    }
}

Vec2 Fluid::Implementation::wall_velocity(std::size_t c) const {
    const WallCell& cell = boundary_.cells()[c];
    const Segment& segment = boundary_.segments()[cell.segment];
    return (1 - cell.centre) * boundary_.velocity(segment.node_a)
           + cell.centre * boundary_.velocity(segment.node_b);
}

/// Books heat into the fluid and an impulse on the wall at one wall cell.
void Fluid::Implementation::pass(std::uint32_t c, double heat, Vec2 impulse) {
    const WallCell& cell = boundary_.cells()[c];
    const Segment& segment = boundary_.segments()[cell.segment];
    const Vec2 velocity = wall_velocity(c);
    if (cell.segment < boundary_.interface_segments()) {
        passed.heat[cell.segment] -= heat;
        passed.impulse[segment.node_a] += (1 - cell.centre) * impulse;
        passed.impulse[segment.node_b] += cell.centre * impulse;
        totals_.work_from_interface -= dot(impulse, velocity);
        return;
    }
    totals_.heat_from_walls += heat;
    totals_.impulse_from_walls -= impulse;
    totals_.work_from_walls -= dot(impulse, velocity);
    if (segment.wall != none) {
        WallReport& wall = walls[segment.wall];
        wall.heat_flow += heat;
        wall.force += impulse;
        wall.torque += cross(segment.a + cell.centre * (segment.b - segment.a), impulse);
    }
}

} // namespace duet::fluid
