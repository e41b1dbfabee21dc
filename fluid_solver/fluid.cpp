#include "fluid_solver/fluid.hpp"

#include "fluid_solver/implementation.hpp"
#include "fluid_solver/shifting.hpp"

#include <algorithm>
#include <cmath>

namespace duet::fluid {

namespace {

constexpr double courant_flow = 0.3;       ///< of dx/U, outer step, and up to
constexpr double courant_smooth = 0.4;     ///< where friction keeps the flow smooth: dx U/nu is
constexpr double smooth_reynolds = 20;     ///< no more than this, and the sound goes no farther
constexpr double smooth_way = 5;           ///< than so many spacings on one geometry
constexpr double fine_reynolds = 6;        ///< dx U/nu up to which particles' slopes are the flow's
constexpr double rough_reynolds = 12;      ///< and from which on they tell nothing of it
constexpr double courant_diffusion = 0.18; ///< of dx^2/max(nu, alpha), outer step
constexpr double courant_sound = 1.65;     ///< of dx/c, inner step (stable to 2.0)
constexpr double courant_paper = 0.3;      ///< of dx/(c + U), the paper's single step, and
constexpr double paper_diffusion = 0.15;   ///< of dx^2/max(nu, alpha)
constexpr double step_tolerance = 1.05;    ///< over the outer limit rather than twice the steps
constexpr double follow_acceleration = 0.1; ///< share of a window's acceleration taken up at once

/// The configuration itself, if it can be modelled.
const Config& checked(const Config& c) {
    if (!(c.spacing > 0) || !(c.density > 0) || !(c.heat_capacity > 0)) {
        throw SceneError("the fluid's spacing, density and heat capacity must be positive");
    }
    if (c.region.size() < 3) {
        throw SceneError("the fluid's region needs at least three corners");
    }
    if (c.formulation == Formulation::paper
        && std::any_of(c.walls.begin(), c.walls.end(), [](const Wall& w) { return w.slip; })) {
        throw SceneError("the paper's formulation knows no walls that slip; take the consistent "
                         "one, or let no wall slip");
    }
    if (c.formulation == Formulation::paper && c.fourth_order) {
        throw SceneError("the paper's formulation has no Laplacian of fourth order; take the "
                         "consistent one, or leave fluid.fourth_order away");
    }
    const auto [left, right] = std::minmax_element(
        c.region.begin(), c.region.end(), [](Vec2 p, Vec2 q) { return p.x < q.x; });
    const auto [low, high] = std::minmax_element(
        c.region.begin(), c.region.end(), [](Vec2 p, Vec2 q) { return p.y < q.y; });
    constexpr double most = 2e8; // some 100 GB
    if ((right->x - left->x) * (high->y - low->y) > most * c.spacing * c.spacing) {
        throw SceneError("a spacing of " + std::to_string(c.spacing)
                         + " m makes more than 2e8 fluid particles; raise fluid.spacing");
    }
    return c;
}

} // namespace

Fluid::Implementation::Implementation(const Config& c,
                                      const std::vector<Chain>& chains,
                                      const InterfaceState& interface)
    : config(c), boundary_(checked(c), chains, interface), grid_(boundary_.grid()),
      evaluation_(c.spacing, c.threads), pressure_(c.threads), wall_estimate_(c.spacing),
      closure_(1, c.threads),
      hydrostatics_(c.density, c.reference_temperature, -c.thermal_expansion * c.gravity),
      interface_position_(interface.position), interface_velocity_(interface.velocity),
      interface_acceleration_(interface.position.size()),
      interface_temperature_(interface.temperature) {
    if (config.formulation == Formulation::paper) {
        paper_.emplace(config.spacing, config.threads);
    }
    buoyant_ = config.thermal_expansion != 0 && norm(config.gravity) > 0;
    forced_ = !config.body_force.is_number() || norm(config.body_force({}, 0)) > 0;
    walls_change_ = std::any_of(config.walls.begin(), config.walls.end(), [](const Wall& wall) {
        return wall.velocity.changes() || wall.heat_flux.changes()
               || (wall.temperature && wall.temperature->changes())
               || (wall.rotation && wall.rotation->rate.changes());
    });
    walls_move_ = std::any_of(config.walls.begin(), config.walls.end(), [](const Wall& wall) {
        return wall.rotation || !wall.velocity.is_number() || norm(wall.velocity({}, 0)) > 0;
    });
    passed.impulse.resize(boundary_.interface_nodes());
    passed.heat.resize(boundary_.interface_segments());
    for (std::size_t w = 0; w < config.walls.size(); ++w) {
        walls.push_back({config.walls[w].name, boundary_.wall_length()[w], 0, 0, {}, 0});
    }
    measure_gaps();
    fill();
    closure_ = Closure(compartments, config.threads);
    compartment_size_.assign(compartments, 0);
    for (const std::uint16_t k : particles.compartment) {
        compartment_size_[k] += 1;
    }
    hydrostatics_.levels.assign(compartments,
                                {{config.reference_temperature, config.reference_temperature}, {}});
    start();
}

/// To be called whenever the fields were set from outside.
void Fluid::Implementation::start() {
    evaluated_ = false;
    particles.rate.assign(particles.size(), Slope{}); // not yet known
    particles.laplacian.assign(config.fourth_order ? particles.size() : 0, Slope{});
    const auto differs = [&](const Fields& f) { return f.T != particles.fields[0].T; };
    heat_ = config.conductivity > 0
            && (boundary_.heated()
                || std::any_of(particles.fields.begin(), particles.fields.end(), differs));
    level();
    take_body_force(time);
    sound_speed_ = 0; // the old one says nothing of the new fields
    measure();
    adapt_sound_speed();
    still_ = at_rest({});
    initial_kinetic_energy_ = kinetic_energy();
    initial_heat_ = config.density * config.heat_capacity * volume
                    * sum([&](std::size_t a) { return particles.fields[a].T; });
    initial_momentum_ = momentum();
}

void Fluid::Implementation::set_fields(const std::function<Values(Vec2)>& field) {
    for (std::size_t a = 0; a < particles.size(); ++a) {
        const Values v = field(particles.position(a));
        particles.fields[a] = {v.velocity.x, v.velocity.y, v.pressure, v.temperature};
        particles.relaxing[a] = 0;
    }
    level();
    for (std::size_t a = 0; a < particles.size(); ++a) {
        particles.fields[a].p -=
            hydrostatics_.pressure(particles.position(a), particles.compartment[a]);
    }
    start();
}

/// How far friction keeps the flow smooth from spacing to spacing. Where it does not, what the
/// slopes of single particles tell of the flow about them disturbs it more than it mends.
double Fluid::Implementation::smoothness() const {
    if (!(config.kinematic_viscosity > 0)) {
        return 0;
    }
    const double reynolds = config.spacing * fastest() / config.kinematic_viscosity;
    return std::clamp((rough_reynolds - reynolds) / (rough_reynolds - fine_reynolds), 0.0, 1.0);
}

double Fluid::Implementation::stable_step() const {
    const double dx = config.spacing;
    double limit = std::numeric_limits<double>::infinity();
    const double nu = still_ ? 0 : config.kinematic_viscosity;
    if (const double slowest = std::max(nu, heat_ ? diffusivity() : 0); slowest > 0) {
        const double share = paper_ ? paper_diffusion : courant_diffusion;
        limit = std::min(limit, share * dx * dx / slowest);
    }
    if (fastest() > 0) {
        const double U = fastest();
        const double share =
            U * dx <= smooth_reynolds * nu
                ? std::clamp(smooth_way * U / sound_speed_, courant_flow, courant_smooth)
                : courant_flow;
        limit = std::min(limit, share * dx / U);
    }
    if (paper_) {
        return std::min(limit, courant_paper * dx / (sound_speed_ + fastest()));
    }
    // Never so long that hundreds of inner steps share one geometry.
    return std::min(limit, 50 * courant_sound * dx / sound_speed_);
}

int Fluid::Implementation::advance(double window,
                                   const InterfaceState& from,
                                   const InterfaceState& to) {
    const Motion motion{&from, &to, window};
    std::fill(passed.impulse.begin(), passed.impulse.end(), Vec2{});
    std::fill(passed.heat.begin(), passed.heat.end(), 0.0);
    for (WallReport& wall : walls) {
        wall.heat_flow = 0;
        wall.force = {};
        wall.torque = 0;
    }
    follow_interface(motion);
    still_ = at_rest(motion);
    int steps = 0;
    for (double elapsed = 0; elapsed < window; ++steps) {
        const double left = window - elapsed;
        const double parts = std::max(1.0, std::ceil(left / (step_tolerance * stable_step())));
        step(left / parts, elapsed, motion);
        elapsed = parts == 1 ? window : elapsed + left / parts;
    }
    time += window;
    for (WallReport& wall : walls) {
        wall.heat += wall.heat_flow;
        wall.heat_flow /= window;
        wall.force *= 1 / window;
        wall.torque /= window;
    }
    for (const Vec2 impulse : passed.impulse) {
        totals_.impulse_from_interface -= impulse;
        totals_.exchanged_impulse += norm(impulse);
    }
    for (const double heat : passed.heat) {
        totals_.heat_from_interface -= heat;
        totals_.exchanged_heat += std::abs(heat);
    }
    return steps;
}

/// One outer step: operators on the geometry of its middle, then `n` inner steps with everything
/// but velocity and pressure frozen.
void Fluid::Implementation::step(double dt, double elapsed, const Motion& motion) {
    if (paper_) {
        return paper_step(dt, elapsed, motion);
    }
    if (still_) {
        return conduct(dt, elapsed, motion);
    }
    begin_step(dt, elapsed, motion);
    {
        const Stamp stamp(phase_seconds_[evaluating]);
        evaluate(dt);
        estimate_slopes();
        take_body_force(time + elapsed + 0.5 * dt);
        for (std::size_t a = 0; a < given_force_.size(); ++a) {
            evaluation_.add_force(a, given_force_[a]);
        }
    }
    {
        const Stamp stamp(phase_seconds_[inner_steps]);
        accelerate(dt);
    }
    {
        const Stamp stamp(phase_seconds_[walls_and_closure]);
        particles.laplacian.swap(evaluation_.laplacian);
        book(dt);
        correct_fields(dt);
        if (boundary_.none_at_all()) {
            close_momentum();
        }
    }
    finish_step(dt, elapsed, motion);
}

/// Whether nothing moves or presses, and nothing will in this window.
bool Fluid::Implementation::at_rest(const Motion& motion) const {
    const auto moves = [](const InterfaceState* state) {
        return state != nullptr
               && std::any_of(state->velocity.begin(), state->velocity.end(), [](Vec2 v) {
                      return norm(v) > 0;
                  });
    };
    return !buoyant_ && !forced_ && !walls_move_ && speed_ == 0 && pressure_range_ == 0
           && !moves(motion.start) && !moves(motion.end)
           && (motion.end == nullptr || motion.end->position == interface_position_);
}

/// A step of heat without flow: the particles stay where they are.
void Fluid::Implementation::conduct(double dt, double elapsed, const Motion& motion) {
    place_interface(elapsed + 0.5 * dt, motion);
    if (heat_) {
        {
            const Stamp stamp(phase_seconds_[evaluating]);
            evaluate(dt);
            estimate_slopes();
            std::fill(evaluation_.shift.begin(), evaluation_.shift.end(), Vec2{});
        }
        const Stamp stamp(phase_seconds_[walls_and_closure]);
        particles.laplacian.swap(evaluation_.laplacian);
        book(dt);
        balance_heat(dt);
        for_particles(particles.size(), config.threads, [&](std::size_t a) {
            closure_.advance_temperature(particles, evaluation_, dt, a);
        });
    }
    place_interface(elapsed + dt, motion);
    const Stamp stamp(phase_seconds_[moving]);
    measure();
}

/// To the middle of the step: what all operators see.
void Fluid::Implementation::begin_step(double dt, double elapsed, const Motion& motion) {
    {
        const Stamp stamp(phase_seconds_[moving]);
        move(0.5 * dt, false);
        interface_before_ = interface_position_;
        place_interface(elapsed + 0.5 * dt, motion);
        hold_off_walls({time + elapsed + 0.5 * dt, 0.5 * dt, false});
    }
    const Stamp stamp(phase_seconds_[sorting]);
    particles.sort(grid_, config.threads);
}

/// To its end, with the shift.
void Fluid::Implementation::finish_step(double dt, double elapsed, const Motion& motion) {
    const Stamp stamp(phase_seconds_[moving]);
    move(0.5 * dt, true);
    interface_before_ = interface_position_;
    place_interface(elapsed + dt, motion);
    check_gaps(time + elapsed + dt);
    hold_off_walls({time + elapsed + dt, 0.5 * dt, true});
    level();
    measure();
    adapt_sound_speed();
}

/// The acceleration that the pressure's slope at the interface takes follows the windows' own
/// within ten of them. The fluid answers it with the mass of the layer beside the wall, m_f = rho
/// dx or less, one window later; taken up at once that runs away on a wall whose own layer m_s is
/// lighter, a' = -(m_f/m_s) a. Taken up by the share s it is stable for s (1 + m_f/m_s) < 2.
void Fluid::Implementation::follow_interface(const Motion& motion) {
    for (std::size_t i = 0; i < boundary_.interface_nodes(); ++i) {
        const Vec2 now =
            (1 / motion.window) * (motion.end->velocity[i] - motion.start->velocity[i]);
        interface_acceleration_[i] += follow_acceleration * (now - interface_acceleration_[i]);
    }
}

/// The interface `elapsed` seconds into the window. Each node moves with the constant acceleration
/// a = (v1 - v0)/window at the mean velocity V = (x1 - x0)/window, so that its way is the integral
/// of its velocity: x = x0 + V t + a t (t - window)/2, v = V + a (t - window/2).
void Fluid::Implementation::place_interface(double elapsed, const Motion& motion) {
    if (walls_change_) {
        boundary_.set_walls(time + elapsed);
    }
    const std::size_t nodes = boundary_.interface_nodes();
    if (nodes == 0) {
        return;
    }
    const InterfaceState &from = *motion.start, &to = *motion.end;
    const double w = elapsed / motion.window;
    const double bend = 0.5 * elapsed * (elapsed - motion.window);
    for (std::size_t i = 0; i < nodes; ++i) {
        // From the start plus a difference, so that a node at rest keeps its place to the bit.
        const Vec2 way = to.position[i] - from.position[i];
        const Vec2 acceleration = (1 / motion.window) * (to.velocity[i] - from.velocity[i]);
        interface_position_[i] = from.position[i] + w * way + bend * acceleration;
        interface_velocity_[i] =
            (1 / motion.window) * way + (elapsed - 0.5 * motion.window) * acceleration;
        interface_temperature_[i] =
            from.temperature[i] + w * (to.temperature[i] - from.temperature[i]);
    }
    put_interface();
}

void Fluid::Implementation::put_interface() {
    boundary_.place(interface_position_);
    boundary_.set_values(interface_velocity_, interface_acceleration_, interface_temperature_);
}

void Fluid::Implementation::move(double dt, bool with_shift) {
    farthest_.resize(chunks_of(particles.size()));
    for_chunks(
        particles.size(), config.threads, [&](std::size_t c, std::size_t first, std::size_t last) {
            double square = 0;
            for (std::size_t a = first; a < last; ++a) {
                const Vec2 gone = way(a, dt, with_shift);
                particles.x[a] += gone.x;
                particles.y[a] += gone.y;
                square = std::max(square, dot(gone, gone));
            }
            farthest_[c] = std::sqrt(square);
        });
    wrap();
}

/// Brings what has left over a periodic side back over the other one.
void Fluid::Implementation::wrap() {
    if (grid_.periodic()) {
        for_particles(particles.size(), config.threads, [&](std::size_t a) {
            put(a, particles.position(a));
        });
    }
}

/// A particle to a place up to a period away from the region.
void Fluid::Implementation::put(std::size_t a, Vec2 place) {
    const Vec2 x = grid_.wrapped(place);
    particles.x[a] = x.x;
    particles.y[a] = x.y;
}

void Fluid::Implementation::evaluate(double dt) {
    const double h = evaluation_.kernel().smoothing_length();
    evaluation_.run(particles,
                    grid_,
                    boundary_,
                    {config.spacing,
                     volume,
                     config.kinematic_viscosity,
                     diffusivity(),
                     shift_factor(h, speed_, dt, config.spacing),
                     heat_,
                     dt,
                     config.fourth_order});
    evaluated_ = true;
}

/// Serial: a formula of the scene is evaluated by one thread at a time.
void Fluid::Implementation::take_body_force(double now) {
    given_force_.resize(forced_ ? particles.size() : 0);
    for (std::size_t a = 0; a < given_force_.size(); ++a) {
        given_force_[a] = config.body_force(particles.position(a), now);
    }
}

void Fluid::Implementation::accelerate(double dt) {
    InnerSteps inner;
    inner.count = static_cast<int>(
        std::max(1.0, std::ceil(dt * sound_speed_ / (courant_sound * config.spacing))));
    inner.step = dt / inner.count;
    inner.density = config.density;
    inner.sound_speed = sound_speed_;
    inner.smoothness = smoothness();
    inner.hydrostatics = &hydrostatics_;
    inner.smoothing_length = evaluation_.kernel().smoothing_length();
    inner.given_force = given_force_;
    const Booked booked = buoyant_ ? pressure_.run<true>(particles, evaluation_, inner)
                                   : pressure_.run<false>(particles, evaluation_, inner);
    // With what the walls' shear puts in (book()) the viscous loss: what the viscous term takes
    // from the motion, -sum m v.(nu lap v). (2 mu D:D sampled at the particles misses a quarter of
    // it in layers a few spacings thin.)
    const double mass = config.density * volume;
    totals_.impulse_from_body_force += mass * booked.impulse;
    totals_.body_force_work += mass * booked.body_force_work;
    totals_.viscous_loss -= mass * booked.viscous_work;
}

/// Closes the heat that has passed.
void Fluid::Implementation::balance_heat(double dt) {
    const double capacity = config.density * config.heat_capacity * volume;
    for (double& heat : passed_heat_) {
        heat /= capacity;
    }
    const ClosureParts parts = closure_.balance(particles, evaluation_, dt, passed_heat_);
    totals_.closure_conduction += capacity * parts.conduction;
    totals_.closure_conduction_abs += capacity * parts.conduction_abs;
    totals_.closure_shift += capacity * parts.shift;
    totals_.closure_shift_abs += capacity * parts.shift_abs;
}

/// Advances T, and corrects all fields for the shift: f += dr . grad f.
void Fluid::Implementation::correct_fields(double dt) {
    if (heat_) {
        balance_heat(dt);
    }
    for_particles(particles.size(), config.threads, [&](std::size_t a) {
        if (heat_) {
            closure_.advance_temperature(particles, evaluation_, dt, a);
        }
        const Vec2 dr = evaluation_.shift[a];
        const Slope &gx = evaluation_.slope_x[a], &gy = evaluation_.slope_y[a];
        Fields& f = particles.fields[a];
        f.u += dr.x * gx.u + dr.y * gy.u;
        f.v += dr.x * gx.v + dr.y * gy.v;
        f.p += dr.x * gx.p + dr.y * gy.p;
    });
}

Fluid::Fluid(const Config& config,
             const std::vector<Chain>& chains,
             const InterfaceState& interface)
    : self_(std::make_unique<Implementation>(config, chains, interface)) {}
Fluid::~Fluid() = default;
Fluid::Fluid(Fluid&&) noexcept = default;
Fluid& Fluid::operator=(Fluid&&) noexcept = default;

void Fluid::set_fields(const std::function<Values(Vec2)>& field) {
    self_->set_fields(field);
}
int Fluid::advance(double window, const InterfaceState& start, const InterfaceState& end) {
    return self_->advance(window, start, end);
}
const InterfaceImpulse& Fluid::passed() const {
    return self_->passed;
}
double Fluid::time() const {
    return self_->time;
}
double Fluid::stable_step() const {
    return self_->stable_step();
}
std::size_t Fluid::size() const {
    return self_->particles.size();
}
std::size_t Fluid::compartments() const {
    return self_->compartments;
}
double Fluid::particle_volume() const {
    return self_->volume;
}
Ledger Fluid::ledger() const {
    return self_->ledger();
}
void Fluid::mark() {
    self_->mark();
}
const std::vector<WallReport>& Fluid::walls() const {
    return self_->walls;
}
std::vector<Phase> Fluid::phases() const {
    return self_->phases();
}
std::vector<std::string> Fluid::model() const {
    return self_->model();
}
Values Fluid::at(Vec2 point) const {
    return self_->at(point);
}
Snapshot Fluid::snapshot() const {
    return self_->snapshot();
}
std::string Fluid::save() const {
    return self_->save();
}
void Fluid::restore(const std::string& state) {
    self_->restore(state);
}

} // namespace duet::fluid
