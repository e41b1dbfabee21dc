// The vector passes of the consistent formulation against obvious twins: each sum written out over
// all pairs, in double precision, one particle at a time (docs/theory-fluid.md). The ghosts' sums
// are taken as they are; fluid_ghosts has their twin.

#include "fluid_solver/pressure.hpp"
#include "fluid_solver/shifting.hpp"
#include "fluid_support.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace duet::fluid::test {
namespace {

constexpr double spacing = 0.1, volume = spacing * spacing;
constexpr double viscosity = 0.3, diffusivity = 0.7, shift_weight = 0.2 * volume;
constexpr double density = 2, sound = 30, inner_step = 0.5 * spacing / sound;
constexpr double outer_step = 0.006; // friction of 0.18 dx^2, conduction of 0.42 dx^2

/// A room with a corner that juts out: heated floor, a lid that moves, a wall that slips, the
/// others insulated.
Config closed_room() {
    Config config =
        closed({{0, 0}, {1.2, 0}, {1.2, 0.6}, {0.7, 0.6}, {0.7, 1.2}, {0, 1.2}}, spacing, false);
    config.walls = {{.name = "floor", .from = {0, 0}, .to = {1.2, 0}, .temperature = 1.5},
                    {.name = "lid", .from = {0, 1.2}, .to = {0.7, 1.2}, .velocity = {0.8, 0}},
                    {.name = "left", .from = {0, 0}, .to = {0, 1.2}, .slip = true}};
    return config;
}

/// A channel without end: its floor is warm, of the lid one part moves; a block stands close to the
/// periodic side.
Config channel() {
    Config config = closed({{0, 0}, {1, 0}, {1, 1.2}, {0.4, 1.2}, {0, 1.2}}, spacing, false);
    config.walls = {{.name = "floor", .from = {0, 0}, .to = {1, 0}, .temperature = 1.5},
                    {.name = "lid", .from = {0, 1.2}, .to = {0.4, 1.2}, .velocity = {0.8, 0}}};
    config.holes = {{{0.05, 0.5}, {0.25, 0.5}, {0.25, 0.7}, {0.05, 0.7}}};
    config.periodic.x = true;
    return config;
}

/// Without walls, one period but two cells long.
Config endless() {
    Config config = closed({{0, 0}, {0.65, 0}, {0.65, 1}, {0, 1}}, spacing, false);
    config.periodic = {true, true};
    return config;
}

/// Particles moved at random, fields without order.
struct Room {
    explicit Room(const Config& scene) : config(scene) {
        boundary.emplace(config, std::vector<Chain>{}, InterfaceState{});
        particles = cloud(*boundary, config, 0.15);
        std::mt19937 random(11);
        std::uniform_real_distribution<double> one(-1, 1);
        for (Fields& f : particles.fields) {
            f = {one(random), one(random), one(random), one(random)};
        }
        for (float& relaxing : particles.relaxing) {
            relaxing = static_cast<float>(one(random));
        }
        const auto single = [&] { return static_cast<float>(one(random)); };
        for (Slope& rate : particles.rate) {
            rate = {single(), single(), 0, single()};
        }
        particles.compartment.assign(particles.size(), 0);
        evaluation.run(particles,
                       boundary->grid(),
                       *boundary,
                       {spacing, volume, viscosity, diffusivity, shift_weight, true, outer_step});
    }
    Config config;
    std::optional<Boundary> boundary;
    Particles particles;
    Evaluation evaluation{spacing, 1};
};

/// Whether a wall, or its image a period away, cuts the line from x to y.
bool cut(const Boundary& boundary, Vec2 x, Vec2 y) {
    const Vec2 period = boundary.grid().period(), r = y - x;
    for (const Segment& s : boundary.segments()) {
        for (const int image : {-1, 0, 1}) {
            const Vec2 a = s.a + Vec2{image * period.x, 0}, t = s.b - s.a;
            const double across = cross(r, t);
            const double f = cross(a - x, t) / across, g = cross(a - x, r) / across;
            if (across != 0 && f > 0 && f < 1 && g >= 0 && g <= 1) {
                return true;
            }
        }
    }
    return false;
}

/// What one field meets at the walls in sight.
struct Walls {
    Mat2 M;
    Third third{};
    DirichletSums known{};
    Vec2 S_value;
    double K_value = 0;
};

/// Sums over all other particles in sight: visit(b, x_ab, V F).
template <class Visit>
void over_pairs(const Room& room, std::size_t a, const Visit& visit) {
    const Kernel& kernel = room.evaluation.kernel();
    const Vec2 x = room.particles.position(a);
    for (std::size_t b = 0; b < room.particles.size(); ++b) {
        Vec2 d = x - room.particles.position(b);
        const Vec2 period = room.boundary->grid().period();
        for (double* way : {&d.x, &d.y}) { // the shortest way, over a periodic side if need be
            const double length = way == &d.x ? period.x : period.y;
            *way += length == 0 || std::abs(*way) < length / 2 ? 0 : *way > 0 ? -length : length;
        }
        if (b != a && norm(d) < kernel.support() && !cut(*room.boundary, x, x - d)) {
            visit(b, d, volume * kernel.slope_over_r(norm(d)));
        }
    }
}

struct Derivatives {
    Mat2 L;
    Vec2 gradient;
    double laplacian = 0;
};

/// Gradient and Laplacian of the field f, exact for linear and quadratic fields.
template <class Field>
Derivatives derivatives(const Room& room, std::size_t a, const Walls& walls, const Field& f) {
    Mat2 M = walls.M;
    Third third = walls.third; // sum V F x_l x_j x_k
    double s[2][2][2]{}, q[2][2][2][2]{};
    Vec2 differences = walls.S_value - f(a) * walls.known.S;
    over_pairs(room, a, [&](std::size_t b, Vec2 x, double VF) {
        const double c[2] = {x.x, x.y}, r2 = dot(x, x);
        M += outer(-VF * x, x);
        differences += (VF * (f(b) - f(a))) * x;
        for (std::size_t m = 0; m < 2; ++m) {
            for (std::size_t jk = 0; jk < 3; ++jk) {
                third[m][jk] += VF * c[m] * c[jk / 2] * c[(jk + 1) / 2];
            }
            for (std::size_t n = 0; n < 2; ++n) {
                for (std::size_t i = 0; i < 2; ++i) {
                    s[m][n][i] += VF * c[m] * c[n] * c[i] / r2;
                    for (std::size_t j = 0; j < 2; ++j) {
                        q[m][n][i][j] += VF * c[m] * c[n] * c[i] * c[j] / r2;
                    }
                }
            }
        }
    });
    Derivatives d;
    d.L = inverse(M);
    d.gradient = d.L * differences;
    // sum_mn B_mn [-q_mnjk - s_mni A_ijk] = delta_jk + (K xi_j xi_k - K xi_i A_ijk)/2
    Eigen::Matrix3d matrix;
    Eigen::Vector3d right;
    for (int jk = 0; jk < 3; ++jk) {
        const auto k = static_cast<std::size_t>(jk);
        const std::size_t first = k / 2, second = (k + 1) / 2;
        const Vec2 A = d.L * Vec2{third[0][k], third[1][k]};
        const auto column = [&](std::size_t m, std::size_t n) {
            return -q[m][n][first][second] - s[m][n][0] * A.x - s[m][n][1] * A.y;
        };
        matrix.row(jk) << column(0, 0), column(0, 1) + column(1, 0), column(1, 1);
        right[jk] =
            (first == second ? 1 : 0) + 0.5 * (walls.known.K_xi_xi[k] - dot(walls.known.K_xi, A));
    }
    const Eigen::Vector3d solved = matrix.fullPivLu().solve(right);
    Eigen::Matrix2d B;
    B << solved[0], solved[1], solved[1], solved[2];
    const Eigen::Vector2d eigen = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(B).eigenvalues();
    double theta = 1; // of I + theta (B - I), so that its eigenvalues keep within 0.2 and 6
    theta = eigen[0] < 0.2 ? std::min(theta, 0.8 / (1 - eigen[0])) : theta;
    theta = eigen[1] > 6 ? std::min(theta, 5 / (eigen[1] - 1)) : theta;
    B = Eigen::Matrix2d::Identity() + theta * (B - Eigen::Matrix2d::Identity());
    Vec2 E = -1.0 * walls.known.K_xi;
    d.laplacian = -(walls.K_value - walls.known.K * f(a));
    over_pairs(room, a, [&](std::size_t b, Vec2 x, double VF) {
        const double r2 = dot(x, x);
        const double eBe =
            (B(0, 0) * x.x * x.x + 2 * B(0, 1) * x.x * x.y + B(1, 1) * x.y * x.y) / r2;
        d.laplacian += 2 * VF * eBe * (f(a) - f(b));
        E += (2 * VF * eBe) * x;
    });
    d.laplacian -= dot(E, d.gradient);
    return d;
}

WallSums wall_sums(const Room& room, std::size_t a, std::vector<Contact>& contacts) {
    WallSums sums{};
    room.boundary->contacts(room.particles.position(a), contacts);
    room.evaluation.ghosts().sums(*room.boundary, contacts, sums);
    if (!sums.slips) {
        sums.v = sums.u;
    }
    return sums;
}

Walls walls_of(const WallSums& w, const DirichletSums& known, const NeumannSums& slope, int lane) {
    return {known.S_xi + slope.N_n,
            known.S_xi_xi + slope.N_d_n_n,
            known,
            {w.Sx_value[lane], w.Sy_value[lane]},
            w.K_value[lane]};
}

/// What one more of a field at a itself changes of its Laplacian there, 1/m2.
double own_share(const Room& room, std::size_t a, Walls walls) {
    walls.S_value = {};
    walls.K_value = 0;
    return derivatives(room, a, walls, [&](std::size_t b) { return b == a ? 1.0 : 0.0; }).laplacian;
}

/// Differences over their bound, the largest of all particles; how many have walls in sight.
struct Largest {
    double value = 0;
    void see(double difference, double bound) {
        value = std::max(value, std::abs(difference) / bound);
    }
};

/// How many particles have walls in sight.
int expect_derivatives_of_twin(const Config& config) {
    const Room room(config);
    // In single precision each of some 20 terms is rounded in a few places, 1e-7 of it: terms of
    // 1/dx in gradients and of 4/dx^2 in Laplacians, the latter multiplied by B and E of up to ten.
    const double slope_bound = 1e-6 / spacing, laplacian_bound = 1e-5 / volume;
    Largest gradient, laplacian, shift;
    int beside_walls = 0;
    std::vector<Contact> contacts;
    for (std::size_t a = 0; a < room.particles.size(); ++a) {
        const WallSums w = wall_sums(room, a, contacts);
        beside_walls += contacts.empty() ? 0 : 1;
        const auto& fields = room.particles.fields;
        const auto u = derivatives(
            room, a, walls_of(w, w.u, w.u_slips, 0), [&](std::size_t b) { return fields[b].u; });
        const auto v = derivatives(
            room, a, walls_of(w, w.v, w.v_slips, 1), [&](std::size_t b) { return fields[b].v; });
        const auto T =
            derivatives(room, a, walls_of(w, w.temperature, w.adiabatic, 3), [&](std::size_t b) {
                return fields[b].T;
            });
        const Slope &gx = room.evaluation.slope_x[a], &gy = room.evaluation.slope_y[a];
        gradient.see(gx.u - u.gradient.x, slope_bound);
        gradient.see(gy.u - u.gradient.y, slope_bound);
        gradient.see(gx.v - v.gradient.x, slope_bound);
        gradient.see(gy.v - v.gradient.y, slope_bound);
        gradient.see(gx.T - T.gradient.x, slope_bound);
        gradient.see(gy.T - T.gradient.y, slope_bound);
        laplacian.see(room.evaluation.viscous[a].x / viscosity - u.laplacian, laplacian_bound);
        laplacian.see(room.evaluation.viscous[a].y / viscosity - v.laplacian, laplacian_bound);
        const double own =
            contacts.empty() ? 0 : own_share(room, a, walls_of(w, w.temperature, w.adiabatic, 3));
        laplacian.see(room.evaluation.heating[a] / diffusivity
                          - T.laplacian / std::max(1.0, -diffusivity * outer_step * own),
                      laplacian_bound);

        Vec2 concentration = w.C, push;
        over_pairs(room, a, [&](std::size_t, Vec2 x, double VF) { concentration += VF * x; });
        for (const Contact& contact : contacts) {
            const double short_of = std::max(0.0, 0.3 * spacing - contact.distance);
            push -= (contact.on_wall() ? 0.2 * short_of : 0) * contact.normal;
        }
        Vec2 dr = push - shift_weight * concentration;
        dr *= norm(dr) > 0.2 * spacing ? 0.2 * spacing / norm(dr) : 1;
        shift.see(norm(room.evaluation.shift[a] - dr), 3e-7 * spacing);
    }
    EXPECT_LT(gradient.value, 1);
    EXPECT_LT(laplacian.value, 1);
    EXPECT_LT(shift.value, 1);
    return beside_walls;
}

TEST(FluidTwins, GradientsLaplaciansAndShift) {
    EXPECT_GT(expect_derivatives_of_twin(closed_room()), 40);
    EXPECT_GT(expect_derivatives_of_twin(channel()), 40);
    EXPECT_EQ(expect_derivatives_of_twin(endless()), 0);
}

/// One inner step: v by pressure, viscous term and buoyancy, then p with the new v.
void expect_inner_step_of_twin(const Config& config) {
    Room room(config);
    const std::vector<Fields> old = room.particles.fields;
    const std::vector<float> old_relaxing = room.particles.relaxing;
    const std::vector<Slope> old_rate = room.particles.rate;
    Hydrostatics hydrostatics(density, 0.2, {3, -40});
    hydrostatics.levels.resize(1);
    hydrostatics.levels[0] = {{0.4, 0.4}, {0.5, 0.5}};
    InnerSteps inner;
    inner.count = 1;
    inner.step = inner_step;
    inner.density = density;
    inner.sound_speed = sound;
    inner.hydrostatics = &hydrostatics;
    inner.smoothing_length = room.evaluation.kernel().smoothing_length();
    Pressure(1).run<true>(room.particles, room.evaluation, inner);
    const std::vector<Fields>& stepped = room.particles.fields;

    const std::size_t n = room.particles.size();
    std::vector<Vec2> slope(n), velocity(n);
    std::vector<WallSums> sums(n);
    std::vector<Contact> contacts;
    Largest moved, accelerated, pressed;
    int slowed = 0;
    for (std::size_t a = 0; a < n; ++a) {
        sums[a] = wall_sums(room, a, contacts);
        Mat2 M = sums[a].N_n;
        Vec2 differences;
        over_pairs(room, a, [&](std::size_t b, Vec2 x, double VF) {
            M += outer(-VF * x, x);
            differences += (VF * (old[b].p - old[a].p)) * x;
        });
        const double T = old[a].T + 0.5 * inner_step * room.evaluation.heating[a];
        const Vec2 b = (T - 0.4) * Vec2{3, -40};
        slope[a] = inverse(M) * (differences + density * (sums[a].N_n * b));
        const Vec2 push = room.evaluation.viscous[a] + b - (1 / density) * slope[a];
        const auto friction = [&](const DirichletSums& known, const NeumannSums& slips, int lane) {
            const double own = own_share(room, a, walls_of(sums[a], known, slips, lane));
            return contacts.empty() ? 0 : std::max(0.0, -viscosity * own - 0.5 / outer_step);
        };
        const double kx = friction(sums[a].u, sums[a].u_slips, 0);
        const double ky = friction(sums[a].v, sums[a].v_slips, 1);
        slowed += kx > 0 || ky > 0 ? 1 : 0;
        const auto changed = [](double force, double k, double late) {
            return inner_step * (force + k * inner_step * late) / (1 + inner_step * k);
        };
        const Slope& late = old_rate[a];
        velocity[a] = {old[a].u + changed(push.x, kx, static_cast<double>(late.u)),
                       old[a].v + changed(push.y, ky, static_cast<double>(late.v))};
        const Slope& now = room.particles.rate[a];
        const auto mean = [](double before, double change) {
            return 0.5 * (before + change / inner_step);
        };
        accelerated.see(norm(Vec2{mean(static_cast<double>(late.u), stepped[a].u - old[a].u)
                                      - static_cast<double>(now.u),
                                  mean(static_cast<double>(late.v), stepped[a].v - old[a].v)
                                      - static_cast<double>(now.v)}),
                        3e-7 / inner_step);
        moved.see(norm(velocity[a] - Vec2{stepped[a].u, stepped[a].v}), 3e-7);
    }
    const auto slopes = [&](std::size_t a, const auto& u, const auto& v) {
        const WallSums& w = sums[a];
        return std::pair{derivatives(room, a, walls_of(w, w.u, w.u_slips, 0), u).gradient,
                         derivatives(room, a, walls_of(w, w.v, w.v_slips, 1), v).gradient};
    };
    for (std::size_t a = 0; a < n; ++a) {
        const auto [du, dv] = slopes(
            a,
            [&](std::size_t b) { return velocity[b].x; },
            [&](std::size_t b) { return velocity[b].y; });
        const auto [du_old, dv_old] = slopes(
            a, [&](std::size_t b) { return old[b].u; }, [&](std::size_t b) { return old[b].v; });
        // The new velocities are half a step ahead of the places.
        const double turned = inner_step * (du_old.x * dv_old.y - du_old.y * dv_old.x);
        double psi = 0;
        over_pairs(room, a, [&](std::size_t b, Vec2 x, double VF) {
            psi += 2 * VF * (old[a].p - old[b].p - 0.5 * dot(slope[a] + slope[b], x));
        });
        const WallTerms* wall = room.evaluation.wall(a);
        const double softness = wall ? wall->softness : 1;
        const double answer = -density * sound * sound * softness * (du.x + dv.y + turned)
                              + 0.1 * inner.smoothing_length * sound * psi;
        const double decay = inner_step * sound / (6 * inner.smoothing_length);
        const double relaxing = (old_relaxing[a] + inner_step * answer) / (1 + decay);
        const double change = 0.5 * inner_step * answer + 0.5 * (relaxing - old_relaxing[a])
                              + inner_step * dot(velocity[a], slope[a]);
        // Of rho c^2 dt (1/dx), the size of what is added, 3e-7.
        const double bound = 3e-7 * density * sound;
        pressed.see(stepped[a].p - old[a].p - change, bound);
        pressed.see(static_cast<double>(room.particles.relaxing[a]) - relaxing, bound);
    }
    EXPECT_LT(moved.value, 1);
    EXPECT_LT(accelerated.value, 1);
    EXPECT_EQ(slowed > 20, !room.boundary->none_at_all());
    EXPECT_LT(pressed.value, 1);
}

TEST(FluidTwins, AnInnerStep) {
    expect_inner_step_of_twin(closed_room());
    expect_inner_step_of_twin(channel());
    expect_inner_step_of_twin(endless());
}

} // namespace
} // namespace duet::fluid::test
