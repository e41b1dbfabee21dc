#include "fluid_solver/fluid_participant.hpp"

#include "fluid_solver/boundary.hpp"
#include "fluid_solver/fluid_probes.hpp"
#include "fluid_solver/scattered_state.hpp"

#include "protocol/function.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace duet::fluid {

namespace {

Vec2 to_vector(const v1::Vector& v) {
    return {v.x(), v.y()};
}

/// Throws std::invalid_argument with a sentence.
Function to_function(const v1::Function& function) {
    if (!function.has_formula() && !function.has_table()) {
        return function.number();
    }
    const protocol::Function read(function);
    return {read, read.depends_on_time()};
}

VectorFunction to_function(const v1::VectorFunction& function) {
    return {to_function(function.x()), to_function(function.y())};
}

template <class Corners>
std::vector<Vec2>
polygon(const Corners& corners, bool is_circle, const v1::Disc& round, double spacing) {
    if (is_circle) {
        return circle(to_vector(round.centre()), round.radius(), spacing);
    }
    std::vector<Vec2> out;
    for (const auto& corner : corners) {
        out.push_back(to_vector(corner));
    }
    return out;
}

Wall wall_of(const v1::Wall& wall, const v1::Fluid& fluid) {
    Wall w;
    w.name = wall.name();
    if (wall.along_size() == 2) {
        w.from = to_vector(wall.along(0));
        w.to = to_vector(wall.along(1));
    }
    if (wall.around() == "region") {
        w.around = 0;
    }
    for (int h = 0; h < fluid.hole_size(); ++h) {
        if (wall.around() == fluid.hole(h).name()) {
            w.around = static_cast<std::size_t>(h) + 1;
        }
    }
    if (wall.has_temperature()) {
        w.temperature = to_function(wall.temperature());
    }
    w.velocity = to_function(wall.velocity());
    if (wall.has_rotation()) {
        w.rotation = {to_vector(wall.rotation().centre()), to_function(wall.rotation().rate())};
    }
    w.heat_flux = to_function(wall.heat_flux());
    w.slip = wall.slip();
    return w;
}

/// What the file holds, in place of the initial fields.
void start_from(const std::string& file, Config& config) {
    Vec2 lower = config.region[0], upper = lower;
    for (const Vec2 c : config.region) {
        lower = {std::min(lower.x, c.x), std::min(lower.y, c.y)};
        upper = {std::max(upper.x, c.x), std::max(upper.y, c.y)};
    }
    const auto state = std::make_shared<ScatteredState>(file, config.periodic, lower, upper);
    const auto take = [&](ScatteredState::Field field, Function& initial) {
        if (state->has(field)) {
            initial = Function(
                [state, field](double x, double y, double) {
                    return state->at(field, {x, y});
                },
                false);
        }
    };
    take(ScatteredState::temperature, config.initial_temperature);
    take(ScatteredState::velocity_x, config.initial_velocity.x);
    take(ScatteredState::velocity_y, config.initial_velocity.y);
}

/// Unpacks [N][2] and [N] arrays into the core's state, reusing its storage.
void unpack(const protocol::InterfaceMotion& motion, InterfaceState& state) {
    const std::size_t nodes = motion.nodes();
    state.position.resize(nodes);
    state.velocity.resize(nodes);
    state.temperature = motion.temperature;
    for (std::size_t i = 0; i < nodes; ++i) {
        state.position[i] = {motion.position[2 * i], motion.position[2 * i + 1]};
        state.velocity[i] = {motion.velocity[2 * i], motion.velocity[2 * i + 1]};
    }
}

/// Impulse and heat of one window as mean loads over it.
void pack(const InterfaceImpulse& passed,
          const protocol::Window& window,
          protocol::InterfaceLoad& load) {
    load.time = window.time;
    load.length = window.length;
    load.force.resize(2 * passed.impulse.size());
    load.heat_flow.resize(passed.heat.size());
    load.impulse_x = load.impulse_y = load.heat = 0;
    for (std::size_t i = 0; i < passed.impulse.size(); ++i) {
        load.force[2 * i] = passed.impulse[i].x / window.length;
        load.force[2 * i + 1] = passed.impulse[i].y / window.length;
        load.impulse_x += passed.impulse[i].x;
        load.impulse_y += passed.impulse[i].y;
    }
    for (std::size_t j = 0; j < passed.heat.size(); ++j) {
        load.heat_flow[j] = passed.heat[j] / window.length;
        load.heat += passed.heat[j];
    }
}

/// Runs `work`; what the core throws becomes the failure that the protocol reports.
template <typename Work>
auto reported(Work&& work) {
    try {
        return work();
    } catch (const std::invalid_argument& error) { // a formula that cannot be read
        throw protocol::Error(v1::Failed::SCENE, error.what());
    } catch (const SceneError& error) {
        throw protocol::Error(v1::Failed::SCENE, error.what());
    } catch (const Diverged& error) {
        throw protocol::Error(v1::Failed::DIVERGED, error.what());
    }
}

} // namespace

Config config_from_scene(const v1::Scene& scene, unsigned threads) {
    const auto& fluid = scene.fluid();
    Config config;
    config.formulation =
        fluid.formulation() == v1::Fluid::PAPER ? Formulation::paper : Formulation::consistent;
    config.spacing = fluid.spacing();
    config.region = polygon(fluid.region(), fluid.has_disc(), fluid.disc(), config.spacing);
    for (const auto& hole : fluid.hole()) {
        config.holes.push_back(
            polygon(hole.corners(), hole.has_disc(), hole.disc(), config.spacing));
    }
    const auto periodic = fluid.periodic();
    config.periodic = {periodic == v1::Fluid::X || periodic == v1::Fluid::BOTH,
                       periodic == v1::Fluid::Y || periodic == v1::Fluid::BOTH};
    config.density = fluid.density();
    config.kinematic_viscosity = fluid.kinematic_viscosity();
    config.heat_capacity = fluid.heat_capacity();
    config.conductivity = fluid.conductivity();
    config.thermal_expansion = fluid.thermal_expansion();
    config.reference_temperature = fluid.reference_temperature();
    config.initial_temperature = to_function(fluid.initial_temperature());
    config.initial_velocity = to_function(fluid.initial_velocity());
    if (!fluid.initial_state().empty()) {
        start_from(fluid.initial_state(), config);
    }
    config.gravity = to_vector(scene.gravity());
    config.body_force = to_function(fluid.body_force());
    for (const auto& wall : fluid.wall()) {
        config.walls.push_back(wall_of(wall, fluid));
    }
    config.pressure_level =
        fluid.pressure_level() == v1::Fluid::FREE ? PressureLevel::free : PressureLevel::zero_mean;
    config.sound_speed = fluid.sound_speed();
    config.seed = fluid.seed();
    config.disorder = fluid.disorder();
    config.fourth_order = fluid.fourth_order();
    config.threads = static_cast<int>(threads > 0 ? threads : 1);
    return config;
}

std::string Participant::name() const {
    return "duet-fluid " DUET_VERSION;
}

void Participant::configure(const v1::Configure& configure,
                            const std::vector<protocol::Chain>& chains,
                            const protocol::InterfaceMotion& start,
                            v1::Ready& ready) {
    scene_ = configure.scene();
    std::vector<Chain> core_chains;
    for (const auto& chain : chains) {
        core_chains.push_back({chain.nodes, chain.closed, chain.insulated, chain.name});
    }
    unpack(start, start_);
    reported([&] {
        fluid_.emplace(config_from_scene(scene_, configure.threads()), core_chains, start_);
        for (const auto& probe : scene_.probe()) {
            if (probe.of() == v1::Probe::FLUID) {
                check_probe(probe, scene_, *fluid_);
            }
        }
    });
    series_.emplace(std::filesystem::path(configure.run_folder()) / "fluid",
                    snapshot::Cell::vertex,
                    std::map<std::string, std::string>{{"title", scene_.title()}});
    write_snapshot();

    ready.set_unknowns(fluid_->size());
    for (const auto& line : fluid_->model()) {
        ready.add_model(line);
    }
    fill(*ready.mutable_ledger());
    ready.set_stable_step(longest_window(ready.ledger()));
    take_probes(*ready.mutable_sample());
}

void Participant::advance(const protocol::Window& window,
                          const protocol::InterfaceMotion& start,
                          const protocol::InterfaceMotion& end,
                          protocol::InterfaceLoad& load,
                          v1::Report& report) {
    unpack(start, start_);
    unpack(end, end_);
    const int steps = reported([&] { return fluid_->advance(window.length, start_, end_); });
    pack(fluid_->passed(), window, load);

    report.set_steps(static_cast<std::uint32_t>(steps));
    fill(*report.mutable_ledger());
    report.set_stable_step(longest_window(report.ledger()));
    load.impedance = scene_.fluid().density() * report.ledger().figure().at("sound_speed");
    if (window.sample) {
        take_probes(*report.mutable_sample());
        fluid_->mark();
        for (const auto& phase : fluid_->phases()) {
            (*report.mutable_timing()->mutable_phase())[phase.name] = phase.seconds;
        }
    }
    if (window.snapshot) {
        write_snapshot();
    }
}

/// Alone, ten of the fluid's own steps: fewer messages. With a solid one, and no more than lets the
/// first layer of a deformable body, rho_s ds, weigh as much as what the sound reaches in the
/// window, rho_f c window (the solid knows c only if the scene gives it).
double Participant::longest_window(const v1::Ledger& now) const {
    constexpr double alone = 10;
    double longest = (scene_.has_solid() ? 1 : alone) * fluid_->stable_step();
    const double sound = scene_.fluid().density() * now.figure().at("sound_speed");
    for (const auto& body : scene_.solid().body()) {
        if (body.motion() == v1::Body::DEFORMABLE && body.has_element_size() && sound > 0) {
            longest = std::min(longest, body.density() * body.element_size() / sound);
        }
    }
    return std::isfinite(longest) ? longest : 0; // 0: no limit
}

std::string Participant::save() const {
    return fluid_->save();
}

void Participant::restore(const std::string& state) {
    reported([&] { fluid_->restore(state); });
}

void Participant::finish() {
    series_.reset();
}

void Participant::fill(v1::Ledger& ledger) const {
    const Ledger now = fluid_->ledger();
    ledger.set_mass(now.mass);
    ledger.set_heat(now.heat);
    ledger.set_heat_from_interface(now.heat_from_interface);
    ledger.set_heat_from_walls(now.heat_from_walls);
    ledger.set_impulse_x(now.impulse_from_interface.x);
    ledger.set_impulse_y(now.impulse_from_interface.y);
    ledger.set_work(now.work_from_interface);
    ledger.set_kinetic_energy(now.kinetic_energy);
    ledger.set_exchanged_heat(now.exchanged_heat);
    ledger.set_exchanged_impulse(now.exchanged_impulse);
    auto& figure = *ledger.mutable_figure();
    double through_walls = 0;
    for (const WallReport& wall : fluid_->walls()) {
        through_walls += std::abs(wall.heat);
    }
    figure["heat_through_walls"] = through_walls; // without signs: what the drift is measured by
    figure["closure_conduction"] = now.closure_conduction;
    figure["closure_conduction_abs"] = now.closure_conduction_abs;
    figure["closure_shift"] = now.closure_shift;
    figure["closure_shift_abs"] = now.closure_shift_abs;
    figure["closure_momentum_abs"] = now.closure_momentum_abs;
    figure["particles_outside"] = static_cast<double>(now.particles_outside);
    figure["wall_hits"] = static_cast<double>(now.wall_hits);
    figure["wall_hit_loss"] = now.wall_hit_loss;
    figure["work_from_walls"] = now.work_from_walls;
    figure["body_force_work"] = now.body_force_work;
    if (scene_.fluid().formulation()
        == v1::Fluid::CONSISTENT) { // the paper's has no velocity slopes
        figure["viscous_loss"] = now.viscous_loss;
        figure["mechanical_residual"] = now.mechanical_residual;
    }
    figure["momentum_x"] = now.momentum.x;
    figure["momentum_y"] = now.momentum.y;
    figure["impulse_from_walls_x"] = now.impulse_from_walls.x;
    figure["impulse_from_walls_y"] = now.impulse_from_walls.y;
    figure["impulse_from_body_force_x"] = now.impulse_from_body_force.x;
    figure["impulse_from_body_force_y"] = now.impulse_from_body_force.y;
    figure["max_speed"] = now.max_speed;
    figure["sound_speed"] = now.sound_speed;
}

void Participant::take_probes(google::protobuf::RepeatedPtrField<v1::Sample>& samples) const {
    for (const auto& probe : scene_.probe()) {
        if (probe.of() == v1::Probe::FLUID) {
            *samples.Add() = take_probe(probe, scene_, *fluid_);
        }
    }
}

void Participant::write_snapshot() {
    const Snapshot now = fluid_->snapshot();
    // A Vec2 is two doubles, so an array of them is the [N][2] array that the file wants.
    static_assert(sizeof(Vec2) == 2 * sizeof(double));
    const auto flat = [](const std::vector<Vec2>& v) {
        return std::span<const double>(v.empty() ? nullptr : &v.front().x, 2 * v.size());
    };
    snapshot::Frame frame;
    frame.time = fluid_->time();
    frame.position = flat(now.position);
    frame.fields = {{"temperature", 1, now.temperature},
                    {"velocity", 2, flat(now.velocity)},
                    {"pressure", 1, now.pressure}};
    series_->append(frame);
}

} // namespace duet::fluid
