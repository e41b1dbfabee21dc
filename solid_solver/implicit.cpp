#include "solid_solver/implicit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace duet::solid {

namespace {

using Vector = Eigen::VectorXd;

std::span<const double> span(const Vector& v) {
    return {v.data(), static_cast<std::size_t>(v.size())};
}
std::span<double> span(Vector& v) {
    return {v.data(), static_cast<std::size_t>(v.size())};
}
Eigen::Map<const Vector> vector(std::span<const double> s) {
    return {s.data(), static_cast<Eigen::Index>(s.size())};
}

} // namespace

Implicit::Implicit(Heat& heat, Mechanics* mechanics) : heat_(heat), mechanics_(mechanics) {
    const auto nodes = static_cast<Eigen::Index>(heat.capacity().size());
    latent_ = stage_latent_ = warming_ = flow_ = Vector::Zero(nodes);
    if (mechanics_) {
        stiffness_.emplace(*mechanics_);
        factored_displacement_.resize(2 * heat.capacity().size());
        factored_temperature_.resize(heat.capacity().size());
        const auto x = mechanics_->position();
        const Eigen::Map<const Eigen::Matrix2Xd> place(
            x.data(), 2, static_cast<Eigen::Index>(x.size() / 2));
        extent_ = (place.rowwise().maxCoeff() - place.rowwise().minCoeff()).norm();
    }
}

bool Implicit::step(double dt) {
    const double gamma = 2 - std::numbers::sqrt2, w = std::numbers::sqrt2 / 4 * dt;
    dt_ = dt;
    tau_ = 0.5 * gamma * dt;
    if (!start()) {
        undo();
        return false;
    }
    stage_ = gamma;
    from_entropy_ = entropy_ + tau_ * flow_;
    if (mechanics_) {
        from_u_ = displacement_ + tau_ * velocity_;
        from_v_ = velocity_ + tau_ * acceleration_;
        u_ = displacement_ + gamma * dt * velocity_;
    }
    if (!solve_stage()) {
        undo();
        return false;
    }
    const Vector first = t_;
    Vector flow(flow_.size());
    heat_.flow(span(first), span(flow));
    Vector received = w * (flow_ + flow);
    stage_ = 1;
    from_entropy_ = entropy_ + received;
    if (mechanics_) {
        const Vector acceleration = (v_ - from_v_) / tau_;
        from_u_ = displacement_ + w * (velocity_ + v_);
        from_v_ = velocity_ + w * (acceleration_ + acceleration);
        u_ += (1 - gamma) * dt * v_;
    }
    if (!solve_stage()) {
        undo();
        return false;
    }
    // Not t_ itself, but what its flows bring: pairs of nodes exchange equal amounts to the last
    // bit, however exact the solution is.
    heat_.flow(span(t_), span(flow));
    received += tau_ * flow;
    heat_.book(w, span(temperature_));
    heat_.book(w, span(first));
    heat_.book(tau_, span(t_));
    const Vector thermoelastic = latent_ - stage_latent_;
    heat_.take(dt, span(received), span(thermoelastic));
    if (mechanics_) {
        mechanics_->accept(dt, span(displacement_), span(v_), heat_.temperature());
    }
    return true;
}

/// State and rates at the start of a step; the factors for its length.
bool Implicit::start() {
    bool factorised = true;
    heat_factor_.prepare(heat_, tau_);
    temperature_ = t_ = vector(heat_.temperature());
    heat_.flow(heat_.temperature(), span(flow_));
    if (mechanics_) {
        displacement_ = vector(mechanics_->displacement());
        velocity_ = vector(mechanics_->velocity());
        latent_ = vector(mechanics_->elasticity().latent_heat());
        mechanics_->look_ahead(0.5 * dt_); // loads are taken in the middle of the step
        acceleration_.resize(displacement_.size());
        for (Eigen::Index c = 0; c < acceleration_.size(); ++c) {
            const auto i = static_cast<std::size_t>(c);
            const double force = mechanics_->load(i) + mechanics_->internal_force()[i];
            const double inverse = mechanics_->inverse_mass()[i];
            acceleration_[c] =
                inverse * force - (inverse > 0 ? mechanics_->mass_damping() * velocity_[c] : 0);
        }
        if (factored_tau_ != tau_) {
            factorised = factorise_anew();
        } else if (at_tau_ != factored_tau_ || at_displacement_ != factored_displacement_
                   || at_temperature_ != factored_temperature_) {
            factorised = factorise_as_kept();
        }
    }
    entropy_ = vector(heat_.capacity()).cwiseProduct(temperature_) + latent_;
    return factorised;
}

bool Implicit::solve_stage() {
    if (!mechanics_ || !mechanics_->elasticity().heats_itself()) {
        solve_temperature();
    }
    return !mechanics_ || solve_motion();
}

/// C T + L = from_entropy + tau q(T), linear in T; L at hand. Prescribed temperatures are on the
/// straight way to their value at the end of the step.
void Implicit::solve_temperature() {
    heat_.for_prescribed([&](std::uint32_t node, double value) {
        t_[node] = temperature_[node] + stage_ * (value - temperature_[node]);
    });
    heat_.flow(span(t_), span(warming_));
    warming_ =
        from_entropy_ + tau_ * warming_ - stage_latent_ - vector(heat_.capacity()).cwiseProduct(t_);
    heat_factor_.solve(warming_);
    t_ += warming_;
}

/// Newton's method for f_ext + f(u, v, T) = M (a + mass damping v).
bool Implicit::solve_motion() {
    constexpr double tolerance = 1e-10; // of the forces at work
    constexpr double resolved = 1e-14;  // of the body's extent: what a position can hold
    constexpr int most = 15, many_solves = 8;
    bool fresh = false;
    for (int i = 0; i < most; ++i) {
        const double error = imbalance();
        if (!std::isfinite(error)) {
            return false;
        }
        if (error <= tolerance) {
            return true;
        }
        const int solves = correct(std::max(1e-4, 0.1 * tolerance / error));
        u_ += correction_;
        if (correction_.lpNorm<Eigen::Infinity>() <= resolved * extent_) {
            return std::isfinite(imbalance());
        }
        fresh = solves > many_solves && !fresh;
        if (fresh) { // the factor has become too unlike the tangent
            imbalance();
            if (!factorise_anew()) {
                return false;
            }
        }
    }
    return false;
}

/// left = f_ext + f(u, v, T) - M (a + mass damping v) with T(u) and v, a by the stage's relations,
/// zero where held. Returns its size relative to the forces at work.
double Implicit::imbalance() {
    v_ = (u_ - from_u_) / tau_;
    if (mechanics_->elasticity().heats_itself()) {
        mechanics_->elasticity().latent_heat(span(u_), span(stage_latent_));
        solve_temperature();
    }
    warming_ = (t_ - temperature_) / dt_; // for the damping alone
    mechanics_->evaluate(span(u_), span(v_), span(t_), span(warming_));
    left_.resize(u_.size());
    double squares = 0;
    for (Eigen::Index c = 0; c < u_.size(); ++c) {
        const auto i = static_cast<std::size_t>(c);
        const double load = mechanics_->load(i), inner = mechanics_->internal_force()[i];
        const double inertia = mechanics_->mass()[i / 2]
                               * ((v_[c] - from_v_[c]) / tau_ + mechanics_->mass_damping() * v_[c]);
        squares += load * load + inner * inner + inertia * inertia;
        left_[c] = mechanics_->inverse_mass()[i] == 0 ? 0 : load + inner - inertia;
    }
    return squares > 0 ? left_.norm() / std::sqrt(squares) : 0;
}

/// correction = J^-1 left by conjugate gradients, preconditioned with the factor at hand: one
/// solve where that is of this tangent, a few where it is of an earlier one, or of nodes that do
/// not exchange heat. Ends where the residual is `reduction` times left. Returns the number of
/// solves.
int Implicit::correct(double reduction) {
    constexpr int most = 60;
    correction_.setZero(left_.size());
    residual_ = left_;
    const double enough = reduction * left_.norm();
    double before = 0;
    for (int i = 1; i <= most; ++i) {
        ++iterations_;
        stiffness_->solve(residual_, precondition_);
        const double product = residual_.dot(precondition_);
        if (i == 1) {
            direction_ = precondition_;
        } else {
            direction_ = precondition_ + product / before * direction_;
        }
        before = product;
        apply(direction_, image_);
        const double curvature = direction_.dot(image_);
        if (!(curvature > 0)) { // buckled on the way: the factor's own step must do
            if (i == 1) {
                correction_ = precondition_;
            }
            return most;
        }
        correction_ += product / curvature * direction_;
        residual_ -= product / curvature * image_;
        if (residual_.norm() <= enough) {
            return i;
        }
    }
    return most;
}

/// image = J x, J = M (1/tau^2 + mass damping/tau) + K with the temperature's answer.
void Implicit::apply(const Vector& x, Vector& image) {
    image.resize(x.size());
    mechanics_->elasticity().apply_tangent(span(x),
                                           span(image),
                                           1 + mechanics_->stiffness_damping() / tau_,
                                           [this](std::vector<double>& nodal) {
                                               warming_ = vector(nodal);
                                               heat_factor_.solve(warming_);
                                               std::copy(
                                                   warming_.begin(), warming_.end(), nodal.begin());
                                           });
    const double inertia = (1 / tau_ + mechanics_->mass_damping()) / tau_;
    for (Eigen::Index c = 0; c < x.size(); ++c) {
        const auto i = static_cast<std::size_t>(c);
        image[c] = mechanics_->inverse_mass()[i] == 0
                       ? 0
                       : image[c] + inertia * mechanics_->mass()[i / 2] * x[c];
    }
}

/// Factorises the tangent at the motion of the last evaluate.
bool Implicit::factorise_anew() {
    const auto u = mechanics_->displacement();
    factored_displacement_.assign(u.begin(), u.end());
    factored_temperature_.assign(t_.begin(), t_.end());
    factored_tau_ = tau_;
    return factorise_as_kept();
}

/// Makes the factor that belongs to the state, and leaves the mechanics as they were.
bool Implicit::factorise_as_kept() {
    const Vector u = vector(mechanics_->displacement());
    const Vector rest = Vector::Zero(u.size()), none = Vector::Zero(t_.size());
    mechanics_->evaluate(factored_displacement_, span(rest), factored_temperature_, span(none));
    Stiffness::Parts parts;
    parts.mass = (1 / factored_tau_ + mechanics_->mass_damping()) / factored_tau_;
    parts.material = 1 + mechanics_->stiffness_damping() / factored_tau_;
    parts.adiabatic = 1;
    const bool factorised = stiffness_->factorise(*mechanics_, parts);
    ++factorisations_;
    mechanics_->evaluate(span(u), span(rest), span(t_), span(none));
    at_displacement_ = factored_displacement_;
    at_temperature_ = factored_temperature_;
    at_tau_ = factored_tau_ = factorised ? factored_tau_ : 0;
    return factorised;
}

void Implicit::undo() {
    if (mechanics_) {
        const Vector none = Vector::Zero(temperature_.size());
        mechanics_->evaluate(span(displacement_), span(velocity_), span(temperature_), span(none));
        mechanics_->look_ahead(0);
    }
}

} // namespace duet::solid
