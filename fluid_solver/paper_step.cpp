// A step in the source paper's formulation: one rate for all, limited by the sound.

#include "fluid_solver/implementation.hpp"
#include "fluid_solver/shifting.hpp"

namespace duet::fluid {

/// 1. x += dt/2 v; sort. 2. (39)-(41), (48), (52) and the shift (43). 3. v, T; then p by (38), (42)
/// with the new v. 4. x += dt/2 v + shift. The fields are not corrected after the shift.
void Fluid::Implementation::paper_step(double dt, double elapsed, const Motion& motion) {
    begin_step(dt, elapsed, motion);
    take_body_force(time + elapsed + 0.5 * dt);
    const paper::Material material{config.density,
                                   config.kinematic_viscosity,
                                   heat_ ? config.conductivity : 0,
                                   config.heat_capacity,
                                   sound_speed_};
    paper_->run(particles,
                grid_,
                boundary_,
                evaluation_.ghosts(),
                hydrostatics_,
                material,
                volume,
                given_force_);
    if (buoyant_ || forced_) {
        totals_.impulse_from_body_force +=
            (dt * config.density * volume) * sum([&](std::size_t a) {
                return (buoyant_ ? hydrostatics_.force(particles.fields[a].T) : Vec2{})
                       + (forced_ ? given_force_[a] : Vec2{});
            });
    }
    for_particles(particles.size(), config.threads, [&](std::size_t a) {
        Fields& f = particles.fields[a];
        f.u += dt * paper_->acceleration[a].x;
        f.v += dt * paper_->acceleration[a].y;
        f.T += dt * paper_->heating[a];
    });
    paper_->compress(particles, material);
    const double strength = paper::shift_strength * fastest() * dt;
    evaluation_.shift.resize(particles.size());
    for_particles(particles.size(), config.threads, [&](std::size_t a) {
        particles.fields[a].p += dt * paper_->pressure_rate[a];
        const double r_o = paper_->mean_distance[a];
        evaluation_.shift[a] =
            shift_vector({}, (strength * r_o * r_o) * paper_->shift[a], 0, config.spacing);
    });
    for (const auto& chunk : paper_->transfers) {
        for (const paper::WallTransfer& transfer : chunk) {
            pass(transfer.cell, dt * transfer.heat_flow, dt * transfer.force);
        }
    }
    finish_step(dt, elapsed, motion);
}

} // namespace duet::fluid
