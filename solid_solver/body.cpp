#include "solid_solver/body.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace duet::solid {

namespace {

constexpr double safety = 0.9; // of the stable step: the frequency moves as the body deforms

BodyConfig checked(BodyConfig config) {
    try {
        check_mesh(config.mesh);
    } catch (const std::invalid_argument& fault) {
        throw std::invalid_argument("Body '" + config.name + "': " + fault.what());
    }
    const std::vector<Material> materials = config.materials();
    if (materials.size() < config.mesh.parts()) {
        throw std::invalid_argument(
            "Body '" + config.name + "' has " + std::to_string(config.mesh.parts()) + " parts, but "
            + std::to_string(materials.size()) + " materials; give one for each part, or none.");
    }
    const bool stiff = std::all_of(
        materials.begin(), materials.end(), [](const Material& m) { return m.youngs_modulus > 0; });
    if (config.motion == Motion::deformable && !stiff) {
        throw std::invalid_argument("Body '" + config.name
                                    + "' is deformable but has no Young's modulus; give "
                                      "youngs_modulus, or make its motion fixed.");
    }
    if (config.kinematics == Kinematics::updated_lagrangian
        && config.stepping == Stepping::implicit_steps && config.motion == Motion::deformable) {
        throw std::invalid_argument("Body '" + config.name
                                    + "' asks for implicit steps in the updated Lagrangian "
                                      "description, which has explicit ones alone; make its "
                                      "kinematics total_lagrangian, or its stepping explicit.");
    }
    return config;
}

} // namespace

Body::Body(BodyConfig config)
    : config_(checked(std::move(config))), domains_(make_domains(config_.mesh, config_.smoothing)),
      heat_(config_, domains_) {
    for (std::size_t t = 0; t < config_.mesh.triangle.size(); ++t) {
        mass_ += config_.material_of(config_.mesh.part_of(t)).density
                 * triangle_area(config_.mesh, config_.mesh.triangle[t]);
    }
    if (config_.motion == Motion::deformable) {
        mechanics_.emplace(config_, domains_, heat_.temperature(), heat_.capacity());
    }
    const bool updated = mechanics_ && config_.kinematics == Kinematics::updated_lagrangian;
    const bool driven = mechanics_ && mechanics_->driven();
    const bool corrected = mechanics_ && config_.mass == Mass::corrected;
    if (corrected && config_.stepping == Stepping::implicit_steps) {
        throw std::invalid_argument("Body '" + config_.name
                                    + "' asks for a corrected mass, which only explicit steps "
                                      "have; leave mass or stepping out.");
    }
    if (driven && config_.stepping == Stepping::implicit_steps) {
        throw std::invalid_argument("Body '" + config_.name
                                    + "' has a boundary that moves as prescribed, which takes "
                                      "explicit steps; give stepping = \"explicit\".");
    }
    if (config_.stepping != Stepping::explicit_steps && !updated && !driven && !corrected) {
        implicit_.emplace(heat_, mechanics_ ? &*mechanics_ : nullptr);
    }
    if (mechanics_ && config_.start == Start::equilibrium) {
        equilibrium_ = find_equilibrium();
    }
    if (config_.motion == Motion::rigid) {
        rigid_.emplace(config_);
    }
    if (mechanics_ || rigid_) {
        return;
    }
    rest_velocity_.assign(2 * nodes(), 0.0);
    for (const Point& p : config_.mesh.node) {
        rest_position_.push_back(p.x());
        rest_position_.push_back(p.y());
    }
    if (config_.motion == Motion::prescribed) {
        move_rigidly(0);
    }
}

/// Puts the nodes of a prescribed body where they are now, x = c + d(t) + R(t) (X - c), with the
/// velocity of that course there: its difference over a ten-thousandth of the last window.
void Body::move_rigidly(double length) {
    const RigidMotion& motion = config_.rigid_motion;
    const auto place = [&](const Point& from, double time) -> Point {
        const Eigen::Rotation2Dd turn(motion.angle(motion.centre, time));
        return motion.centre + motion.displacement(motion.centre, time)
               + turn * (from - motion.centre);
    };
    const double reach = length > 0 ? 1e-4 * length : 1e-6;
    const double before = std::max(0.0, time_ - reach), after = time_ + reach;
    for (std::size_t i = 0; i < nodes(); ++i) {
        const Point from = config_.mesh.node[i];
        const Point x = place(from, time_);
        const Point v = (place(from, after) - place(from, before)) / (after - before);
        for (std::size_t d = 0; d < 2; ++d) {
            const auto k = static_cast<Eigen::Index>(d);
            rest_position_[2 * i + d] = x[k];
            rest_velocity_[2 * i + d] = v[k];
        }
    }
}

void Body::set_interface_load(std::span<const double> heat, std::span<const double> force) {
    heat_.set_interface_heat(heat);
    if (mechanics_) {
        mechanics_->set_interface_force(force);
    } else if (rigid_) {
        rigid_->set_interface_force(force);
    }
}

double Body::stable_step() const {
    const double thermal = heat_.stable_step();
    const double mechanical = mechanics_ ? mechanics_->stable_step() : 0;
    if (thermal == 0 || mechanical == 0) {
        return std::max(thermal, mechanical);
    }
    return std::min(thermal, mechanical);
}

// The order of section 2.3 of the paper, thermal before mechanical: the heat takes the strain rate
// of the motion made last, the stress takes the new temperature. Started and ended at whole steps,
// so the motion that the heat takes its rate from stands first. The staggering is centred in time.
void Body::step(double dt) {
    heat_.set_time(time_, time_ + dt);
    time_ += dt;
    if (!mechanics_) {
        heat_.step(dt);
        return;
    }
    mechanics_->drift(dt);
    heat_.step(dt, mechanics_->heating(dt));
    mechanics_->respond(dt, heat_.temperature());
}

std::uint32_t Body::advance(double length) {
    if (choice_ == 0) {
        choice_ = plan(length).implicit ? 2 : 1;
    }
    const std::uint32_t steps =
        choice_ == 2 ? advance_implicitly(length) : advance_explicitly(length);
    if (config_.motion == Motion::prescribed) {
        move_rigidly(length);
    } else if (rigid_) {
        rigid_->advance(length);
    }
    check_finite();
    return steps;
}

Body::Plan Body::plan(double length) const {
    const double worth = config_.implicit_worth;
    const double limit = safety * stable_step();
    const double steps = limit > 0 ? std::max(1.0, std::ceil(length / limit)) : 1;
    if (config_.stepping != Stepping::automatic || !implicit_) {
        return {config_.stepping == Stepping::implicit_steps, steps, "as asked for"};
    }
    std::ostringstream reason;
    const double longest = config_.implicit_step > 0 ? config_.implicit_step : length;
    const double implicit_steps = std::max(1.0, std::ceil(length / longest * (1 - 1e-12)));
    const bool implicit = steps > worth * implicit_steps;
    reason << steps << " explicit steps would " << (implicit ? "" : "not ") << "cost more than "
           << implicit_steps << " implicit, worth " << worth << " each";
    return {implicit, steps, reason.str()};
}

std::uint32_t Body::advance_implicitly(double length) {
    const double longest = config_.implicit_step > 0 ? config_.implicit_step : length;
    double count = std::max(1.0, std::ceil(length / longest * (1 - 1e-12)));
    std::uint32_t taken = 0;
    for (double left = length; count > 0;) {
        const double dt = left / count;
        heat_.set_time(time_, time_ + dt);
        if (implicit_->step(dt)) {
            time_ += dt;
            left -= dt;
            --count;
            ++taken;
        } else if (dt < 1e-4 * length) {
            std::ostringstream sentence;
            sentence << "Body '" << config_.name << "': no implicit step converges, not even of "
                     << dt << " s; its loads are too large for its stiffness.";
            throw std::runtime_error(sentence.str());
        } else {
            count *= 2;
        }
    }
    return taken;
}

std::uint32_t Body::advance_explicitly(double length) {
    constexpr double steps_between_updates = 256;
    if (mechanics_) {
        mechanics_->add_damping(exchange_damping_);
    }
    std::uint32_t taken = 0;
    for (double left = length; left > 0;) {
        const double limit = safety * stable_step();
        const double count = limit > 0 ? std::max(1.0, std::ceil(left / limit)) : 1;
        const double steps = std::min(count, steps_between_updates);
        const double dt = left / count;
        for (double i = 0; i < steps; ++i) {
            step(dt);
        }
        check_finite();
        taken += static_cast<std::uint32_t>(steps);
        left = steps < count ? left - steps * dt : 0;
        steps_since_update_ += steps;
        if (mechanics_ && steps_since_update_ >= steps_between_updates) {
            mechanics_->update_frequency();
            steps_since_update_ = 0;
        }
    }
    return taken;
}

Equilibrium Body::find_equilibrium(double tolerance) {
    try {
        return config_.kinematics == Kinematics::total_lagrangian
                   ? solid::find_equilibrium(mechanics_.value(), temperature(), tolerance)
                   : relax(mechanics_.value(), temperature(), tolerance);
    } catch (const std::runtime_error& fault) {
        throw std::runtime_error("Body '" + config_.name + "': " + fault.what());
    }
}

void Body::check_finite() const {
    const std::span<const double> t = temperature(), v = velocity();
    for (std::size_t i = 0; i < nodes(); ++i) {
        if (!std::isfinite(t[i] + v[2 * i] + v[2 * i + 1])) {
            std::ostringstream sentence;
            sentence << "Body '" << config_.name << "' has left the finite numbers at its node "
                     << i << ", material point (" << config_.mesh.node[i].x() << ", "
                     << config_.mesh.node[i].y()
                     << "); the loads are too large for its stiffness or the window too long.";
            throw std::runtime_error(sentence.str());
        }
    }
}

std::span<const double> Body::position() const {
    return mechanics_ ? mechanics_->position()
           : rigid_   ? rigid_->position()
                      : std::span<const double>(rest_position_);
}

std::span<const double> Body::velocity() const {
    return mechanics_ ? mechanics_->velocity()
           : rigid_   ? rigid_->velocity()
                      : std::span<const double>(rest_velocity_);
}

double Body::kinetic_energy() const {
    return mechanics_ ? mechanics_->kinetic_energy() : rigid_ ? rigid_->kinetic_energy() : 0;
}

EnergyAccount& EnergyAccount::operator+=(const EnergyAccount& other) {
    interface += other.interface;
    loads += other.loads;
    supports += other.supports;
    expansion += other.expansion;
    dissipated += other.dissipated;
    steps += other.steps;
    stored += other.stored;
    return *this;
}

EnergyAccount Body::energy() const {
    EnergyAccount out;
    if (rigid_) {
        out.stored = rigid_->stored_energy();
        out.interface = rigid_->interface_work();
        out.loads = rigid_->load_work();
    }
    if (mechanics_) {
        const Work& work = mechanics_->work();
        out.stored = mechanics_->stored_energy();
        out.interface = work.interface;
        out.loads = work.loads;
        out.supports = mechanics_->support_work();
        out.expansion = mechanics_->elasticity().expansion_work();
        out.steps = work.steps;
        out.dissipated = work.mass_damping + mechanics_->elasticity().damping_loss();
        if (choice_ == 2) {
            out.dissipated -= out.residual();
        }
    }
    return out;
}

double Body::strain_energy() const {
    return mechanics_ ? mechanics_->strain_energy() : rigid_ ? rigid_->spring_energy() : 0;
}

} // namespace duet::solid
