#include "solid_solver/solid_participant.hpp"

#include "solid_solver/solid_scene.hpp"
#include "solid_solver/state.hpp"

#include <algorithm>
#include <cstring>
#include <sstream>

namespace duet::solid {

namespace {

/// Runs `work`; what the core throws becomes the failure that the protocol reports.
template <class Work>
auto reported(const Work& work) {
    try {
        return work();
    } catch (const std::invalid_argument& fault) {
        throw protocol::Error(v1::Failed::SCENE, fault.what());
    } catch (const std::runtime_error& fault) {
        throw protocol::Error(v1::Failed::DIVERGED, fault.what());
    }
}

/// The corners of the cavity; a round one as a polygon, whose corners do not matter to a body that
/// lies inside it.
std::vector<Point> region_of(const v1::Fluid& fluid) {
    std::vector<Point> region;
    for (const v1::Vector& corner : fluid.region()) {
        region.emplace_back(corner.x(), corner.y());
    }
    constexpr int sides = 720;
    for (int i = 0; fluid.has_disc() && i < sides; ++i) {
        const double angle = 2 * std::acos(-1.0) * i / sides;
        region.emplace_back(fluid.disc().centre().x() + fluid.disc().radius() * std::cos(angle),
                            fluid.disc().centre().y() + fluid.disc().radius() * std::sin(angle));
    }
    return region;
}

/// What the exchange damping is measured by: the fluid's impedance, fourfold where both advance at
/// once, for there the load is later by a window and feeds slower vibrations, and these more
/// strongly.
double impedance_of(const v1::Coupling& coupling, const protocol::InterfaceLoad& load) {
    if (!coupling.damping()) {
        return 0;
    }
    return (coupling.schedule() == v1::Coupling::PARALLEL ? 4 : 1) * load.impedance;
}

} // namespace

std::string Participant::name() const {
    return "duet-solid " DUET_VERSION;
}

void Participant::configure(const v1::Configure& configure,
                            v1::Ready& ready,
                            std::vector<protocol::Chain>& chains,
                            protocol::InterfaceMotion& start) {
    scene_ = configure.scene();
    const std::vector<Point> region = region_of(scene_.fluid());
    reported([&] {
        std::vector<BodyConfig> bodies;
        for (const v1::Body& body : scene_.solid().body()) {
            bodies.push_back(config_from_scene(body, configure.threads(), configure.run_folder()));
        }
        solid_ = std::make_unique<Solid>(std::move(bodies), region);
        probes_ = Probes(scene_, *solid_);
    });
    series_.emplace(std::filesystem::path(configure.run_folder()) / "solid",
                    snapshot::Cell::triangle,
                    std::map<std::string, std::string>{{"title", scene_.title()}});
    write_snapshot();

    for (const Interface::Chain& chain : solid_->interface().chain) {
        const Body& body = solid_->bodies()[solid_->interface().node[chain.node[0]].body];
        chains.push_back({chain.node, chain.closed, body.config().insulated, body.config().name});
    }
    fill(start);
    ready.set_stable_step(longest_window());
    ready.set_nodes(solid_->interface().node.size());
    ready.set_segments(solid_->interface().segment.size());
    describe(ready);
    fill(*ready.mutable_ledger());
    probes_.take(*solid_, time_, *ready.mutable_sample());
}

void Participant::advance(const protocol::Window& window,
                          const protocol::InterfaceLoad& load,
                          protocol::InterfaceMotion& end,
                          v1::Report& report) {
    report.set_steps(reported([&] {
        return solid_->advance(
            window.length, load.force, load.heat_flow, impedance_of(scene_.coupling(), load));
    }));
    time_ = window.time + window.length;
    impedance_ = load.impedance;
    fill(end);
    report.set_stable_step(longest_window());
    fill(*report.mutable_ledger());
    if (window.sample) {
        probes_.take(*solid_, time_, *report.mutable_sample());
    }
    if (window.snapshot) {
        write_snapshot();
    }
}

std::string Participant::save() const {
    std::string bytes(reinterpret_cast<const char*>(&time_), sizeof time_);
    return bytes + save_state(*solid_);
}

void Participant::restore(const std::string& state) {
    reported([&] {
        if (state.size() < sizeof time_) {
            throw std::invalid_argument("The saved state of the solid is empty.");
        }
        restore_state(*solid_, state.substr(sizeof time_));
    });
    std::memcpy(&time_, state.data(), sizeof time_);
}

void Participant::finish() {
    series_.reset();
}

/// The solid takes sub-steps of its own within a window; what limits the window is the exchange:
/// loads are frozen in it, while the first layer of the solid already answers.
double Participant::longest_window() const {
    const v1::Fluid& fluid = scene_.fluid();
    const double heat = solid_->exchange_limit(fluid.conductivity(), fluid.spacing());
    const double sound = fluid.density() * fluid.sound_speed();
    const double mass = solid_->added_mass_limit(1, std::max(sound, impedance_));
    const double drag =
        solid_->drag_limit(fluid.density() * fluid.kinematic_viscosity(), fluid.spacing());
    double longest = 0;
    for (const double limit : {heat, mass, drag}) {
        longest = longest > 0 && limit > 0 ? std::min(longest, limit) : std::max(longest, limit);
    }
    return longest;
}

void Participant::fill(protocol::InterfaceMotion& motion) const {
    motion.time = time_;
    solid_->interface_state(motion.position, motion.velocity, motion.temperature);
}

void Participant::fill(v1::Ledger& ledger) const {
    double mass = 0, heat = 0, walls = 0, sources = 0, thermoelastic = 0;
    double kinetic = 0, strain = 0;
    EnergyAccount energy;
    for (const Body& body : solid_->bodies()) {
        const HeatAccount& account = body.heat().account();
        mass += body.mass();
        heat += body.heat().stored();
        walls += account.walls;
        sources += account.sources + account.thermoelastic;
        thermoelastic += account.thermoelastic;
        kinetic += body.kinetic_energy();
        strain += body.strain_energy();
        energy += body.energy();
    }
    const InterfaceAccount& passed = solid_->account();
    ledger.set_mass(mass);
    ledger.set_heat(heat);
    ledger.set_heat_from_interface(passed.heat);
    ledger.set_heat_from_walls(walls);
    ledger.set_heat_from_sources(sources);
    ledger.set_impulse_x(passed.impulse_x);
    ledger.set_impulse_y(passed.impulse_y);
    ledger.set_work(passed.work);
    ledger.set_kinetic_energy(kinetic);
    ledger.set_strain_energy(strain);
    ledger.set_exchanged_heat(passed.exchanged_heat);
    ledger.set_exchanged_impulse(passed.exchanged_impulse);
    auto& figure = *ledger.mutable_figure();
    figure["thermoelastic_heat"] = thermoelastic;
    figure["work_of_own_loads"] = energy.loads;
    figure["work_of_supports"] = energy.supports;
    figure["work_of_expansion"] = energy.expansion;
    figure["dissipated"] = energy.dissipated;
    figure["energy_of_steps"] = energy.steps;
    figure["energy_residual"] = energy.residual();
}

namespace {

std::string deformable_model(const Body& body) {
    std::ostringstream text;
    text << "deformable, "
         << (body.config().kinematics == Kinematics::updated_lagrangian ? "updated" : "total")
         << " Lagrangian, plane " << (body.config().plane == Plane::stress ? "stress" : "strain");
    if (body.equilibrium()) {
        text << ", starts in equilibrium (residual " << body.equilibrium()->residual << " after "
             << body.equilibrium()->iterations << " iterations)";
    }
    return text.str();
}

/// Which steps the body takes in a window, and why.
std::string steps_model(const Body& body, double window) {
    if (body.config().stepping == Stepping::automatic && !(window > 0)) {
        return "; explicit or implicit steps, whichever cost less in the first window";
    }
    const Body::Plan plan = body.plan(window);
    return std::string("; ") + (plan.implicit ? "implicit" : "explicit") + " steps, " + plan.reason;
}

} // namespace

void Participant::describe(v1::Ready& ready) const {
    std::uint64_t unknowns = 0;
    for (const Body& body : solid_->bodies()) {
        std::ostringstream line;
        line << "body " << body.config().name << ": "
             << (body.deformable() ? deformable_model(body)
                 : body.config().motion == Motion::prescribed
                     ? "rigid, moved as prescribed, heat alone"
                 : body.rigid() ? "rigid, moved by the forces on it"
                                : "fixed, heat alone")
             << ", " << body.nodes() << " nodes, " << body.config().mesh.triangle.size()
             << " triangles, " << body.domains().size() << " smoothing domains, stable step "
             << body.stable_step() << " s" << steps_model(body, scene_.time().window());
        ready.add_model(line.str());
        unknowns += body.nodes();
    }
    ready.set_unknowns(unknowns);
}

/// All bodies in one frame, one behind the other.
void Participant::write_snapshot() {
    const auto& bodies = solid_->bodies();
    const bool moving = std::any_of(bodies.begin(), bodies.end(), [](const Body& b) {
        return b.config().motion != Motion::fixed;
    });
    std::vector<double> position, velocity, displacement, temperature;
    std::vector<double> xx, yy, xy, zz, von_mises;
    std::vector<std::uint32_t> connectivity;
    for (const Body& body : bodies) {
        const auto before = static_cast<std::uint32_t>(temperature.size());
        for (const Triangle& triangle : body.config().mesh.triangle) {
            for (const std::uint32_t node : triangle) {
                connectivity.push_back(before + node);
            }
        }
        const auto x = body.position(), v = body.velocity(), t = body.temperature();
        position.insert(position.end(), x.begin(), x.end());
        temperature.insert(temperature.end(), t.begin(), t.end());
        if (!moving) {
            continue;
        }
        velocity.insert(velocity.end(), v.begin(), v.end());
        for (std::size_t i = 0; i < body.nodes(); ++i) {
            displacement.push_back(x[2 * i] - body.config().mesh.node[i].x());
            displacement.push_back(x[2 * i + 1] - body.config().mesh.node[i].y());
        }
        std::vector<PlaneTensor> stress(body.nodes());
        if (body.mechanics()) {
            stress = body.mechanics()->nodal_stress(t);
        }
        for (const PlaneTensor& s : stress) {
            xx.push_back(s.xx);
            yy.push_back(s.yy);
            xy.push_back(s.xy);
            zz.push_back(s.zz);
            von_mises.push_back(s.von_mises());
        }
    }
    snapshot::Frame frame;
    frame.time = time_;
    frame.position = position;
    frame.connectivity = connectivity;
    frame.fields = {{"temperature", 1, temperature}};
    if (moving) {
        frame.fields.push_back({"displacement", 2, displacement});
        frame.fields.push_back({"velocity", 2, velocity});
        frame.fields.push_back({"stress_xx", 1, xx});
        frame.fields.push_back({"stress_yy", 1, yy});
        frame.fields.push_back({"stress_xy", 1, xy});
        frame.fields.push_back({"stress_zz", 1, zz});
        frame.fields.push_back({"von_mises", 1, von_mises});
    }
    series_->append(frame);
}

} // namespace duet::solid
