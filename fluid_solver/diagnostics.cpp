// What can be asked of the fluid: ledgers, fields at points, snapshots.

#include "fluid_solver/implementation.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <optional>
#include <sstream>

namespace duet::fluid {

double Fluid::Implementation::kinetic_energy() const {
    return 0.5 * config.density * volume * sum([&](std::size_t a) {
               const Fields& f = particles.fields[a];
               return f.u * f.u + f.v * f.v;
           });
}

Ledger Fluid::Implementation::ledger() const {
    const double m = config.density * volume, capacity = m * config.heat_capacity;
    const auto count = static_cast<double>(particles.size());
    const double temperature = sum([&](std::size_t a) { return particles.fields[a].T; });
    Ledger l = totals_;
    l.mass = m * count;
    l.heat = capacity * temperature - initial_heat_;
    l.mean_temperature = temperature / count;
    l.kinetic_energy = kinetic_energy();
    l.momentum = momentum() - initial_momentum_;
    l.mechanical_residual = l.kinetic_energy - initial_kinetic_energy_ - l.work_from_interface
                            - l.work_from_walls - l.body_force_work + l.viscous_loss
                            + l.wall_hit_loss;
    const double since = time - mark_.time;
    if (since > 0) {
        l.force_on_solids = (1 / since) * (mark_.impulse - l.impulse_from_interface);
        l.heat_flow_to_solids = (mark_.heat - l.heat_from_interface) / since;
    }
    l.max_speed = speed_;
    l.sound_speed = sound_speed_;
    l.particles_outside = static_cast<std::uint64_t>(sum([&](std::size_t a) {
        const Vec2 x = particles.position(a);
        return boundary_.near(x) && boundary_.nearest(x).distance < 0 ? 1.0 : 0.0;
    }));
    return l;
}

void Fluid::Implementation::mark() {
    mark_ = {time, totals_.heat_from_interface, totals_.impulse_from_interface};
}

namespace {

/// Weighted least squares of some fields at once for a quadratic (six terms, scaled by the support)
/// or, with too few points, a plane or a constant about the point asked for.
template <int fields>
class LocalFit {
  public:
    using Row = Eigen::Matrix<double, 6, 1>;
    using Normal = Eigen::Matrix<double, 6, 6>;
    using Right = Eigen::Matrix<double, 6, fields>;

    LocalFit(const Normal& normal, const Right& right, int points)
        : normal_(normal), right_(right), points_(points) {}

    void add(const Row& row, double weight, double value) {
        normal_ += weight * row * row.transpose();
        right_ += weight * value * row;
        ++points_;
    }
    /// By columns the fields' values and scaled gradients at the point: value, along x, along y.
    Eigen::Matrix<double, 3, fields> result() const {
        Eigen::Matrix<double, 3, fields> all;
        all.setZero();
        if (const auto quadratic = solve<6>()) {
            all = quadratic->template topRows<3>();
        } else if (const auto plane = solve<3>()) {
            all = *plane;
        } else if (const auto constant = solve<1>()) {
            all.row(0) = *constant;
        } else {
            all.setConstant(std::numeric_limits<double>::quiet_NaN());
        }
        return all;
    }

  private:
    Normal normal_;
    Right right_;
    int points_;

    /// The first `terms` coefficients, if the points determine them. (The ratio of the pivots
    /// bounds the condition well enough for so few terms.)
    template <int terms>
    std::optional<Eigen::Matrix<double, terms, fields>> solve() const {
        if (points_ < terms) {
            return {};
        }
        const Eigen::LDLT<Eigen::Matrix<double, terms, terms>> factor(
            normal_.template topLeftCorner<terms, terms>());
        const auto pivots = factor.vectorD();
        if (!(pivots.minCoeff() > 1e-10 * pivots.maxCoeff())) {
            return {};
        }
        return factor.solve(right_.template topRows<terms>());
    }
};

} // namespace

Values Fluid::Implementation::at(Vec2 point) const {
    point = grid_.wrapped(point);
    // A point on a wall is taken just before it.
    const double skin = 1e-3 * config.spacing;
    if (const auto wall = boundary_.nearest(point); std::abs(wall.distance) < skin) {
        point = wall.point - skin * wall.face->normal;
    } else if (!boundary_.contains(point)) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        return {nan, {nan, nan}, nan, {nan, nan}};
    }
    const Kernel& kernel = evaluation_.kernel();
    const double R = kernel.support();
    std::vector<Contact> contacts;
    boundary_.contacts(point, contacts);
    const auto terms = [R](Vec2 r) {
        const double x = r.x / R, y = r.y / R;
        return LocalFit<1>::Row{1, x, y, x * x, x * y, y * y};
    };
    // The particles count alike for u, v, p and T.
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 4> right = Eigen::Matrix<double, 6, 4>::Zero();
    int points = 0;
    // Since they were sorted the particles have moved by half a step and the shift: less than half
    // a spacing.
    grid_.for_cells_within(point, R + 0.5 * config.spacing, [&](std::size_t cell) {
        for (std::uint32_t a = particles.cell_start()[cell]; a < particles.cell_start()[cell + 1];
             ++a) {
            const Vec2 r = grid_.shortest(particles.position(a) - point);
            if (dot(r, r) < R * R && !Ghosts::hidden(contacts, r)) {
                const Fields& f = particles.fields[a];
                const double head =
                    hydrostatics_.pressure(particles.position(a), particles.compartment[a]);
                const LocalFit<1>::Row one = terms(r), weighted = kernel.value(norm(r)) * one;
                normal += weighted * one.transpose();
                right += weighted * Eigen::RowVector4d(f.u, f.v, f.p + head, f.T);
                ++points;
            }
        }
    });
    if (contacts.empty()) {
        const auto f = LocalFit<4>(normal, right, points).result();
        return {f(0, 3), {f(0, 0), f(0, 1)}, f(0, 2), (1 / R) * Vec2{f(1, 3), f(2, 3)}};
    }
    LocalFit<1> u(normal, right.col(0), points), v(normal, right.col(1), points),
        p(normal, right.col(2), points), T(normal, right.col(3), points);
    // Walls contribute what is known of them, at points half a spacing apart.
    for (const Contact& contact : contacts) {
        for (int i = -5; i <= 5; ++i) {
            const double ahead = 0.5 * i * config.spacing;
            const Vec2 r = contact.distance * contact.normal + ahead * contact.tangent;
            if (ahead < -contact.before() || ahead > contact.after() || norm(r) >= R) {
                continue;
            }
            const double w = kernel.value(norm(r));
            const Lanes wall = boundary_.at(*contact.face, contact.foot + ahead).value;
            if (contact.face->knows_u()) {
                u.add(terms(r), w, wall[0]);
            }
            if (contact.face->knows_v()) {
                v.add(terms(r), w, wall[1]);
            }
            if (contact.face->heated && heat_) {
                T.add(terms(r), w, wall[3]);
            }
        }
    }
    const auto temperature = T.result();
    return {temperature[0],
            {u.result()[0], v.result()[0]},
            p.result()[0],
            (1 / R) * Vec2{temperature[1], temperature[2]}};
}

Snapshot Fluid::Implementation::snapshot() const {
    const std::size_t n = particles.size();
    Snapshot s;
    s.position.resize(n);
    s.velocity.resize(n);
    s.temperature.resize(n);
    s.pressure.resize(n);
    for (std::size_t a = 0; a < n; ++a) {
        const std::size_t i = particles.identity[a];
        const Fields& f = particles.fields[a];
        s.position[i] = particles.position(a);
        s.velocity[i] = {f.u, f.v};
        s.temperature[i] = f.T;
        s.pressure[i] = f.p + hydrostatics_.pressure(s.position[i], particles.compartment[a]);
    }
    return s;
}

std::vector<Phase> Fluid::Implementation::phases() const {
    return {{"move", phase_seconds_[moving]},
            {"sort", phase_seconds_[sorting]},
            {"operators", phase_seconds_[evaluating]},
            {"inner steps", phase_seconds_[inner_steps]},
            {"walls and closure", phase_seconds_[walls_and_closure]}};
}

std::vector<std::string> Fluid::Implementation::model() const {
    std::ostringstream size, physics;
    size << particles.size() << " fluid particles of " << volume << " m2 at a spacing of "
         << config.spacing << " m in " << compartments
         << (compartments == 1 ? " compartment" : " compartments");
    physics << (paper_   ? "weakly compressible flow, "
                : still_ ? "no flow as long as nothing moves, "
                         : "incompressible flow by artificial compressibility, ")
            << (heat_ ? "heat" : "no heat (one temperature)") << ", "
            << (buoyant_ ? "Boussinesq buoyancy" : "no buoyancy")
            << (forced_ ? ", body force" : "");
    return {size.str(),
            physics.str(),
            paper_ ? "formulation: the source paper's, cubic spline, h = 1.2 spacings"
            : config.fourth_order
                ? "formulation: consistent, Wendland C2, support 2.6 spacings, fourth order"
                : "formulation: consistent, Wendland C2, support 2.6 spacings"};
}

} // namespace duet::fluid
