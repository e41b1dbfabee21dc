// The source paper's formulation against its sums written out over all pairs.

#include "fluid_solver/paper_formulation.hpp"
#include "fluid_support.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace duet::fluid::test {
namespace {

constexpr double spacing = 0.1;

TEST(FluidPaper, KernelIntegratesToOneAndFallsAsItsSlopeSays) {
    // int W = -1/2 int r . gradW over the plane = -pi int F r^3 dr.
    const double h = 0.12;
    double integral = 0;
    const int steps = 4000;
    for (int i = 0; i < steps; ++i) {
        const double r = 2 * h * (i + 0.5) / steps;
        integral -= std::numbers::pi * paper::slope_over_r(r, h) * r * r * r * 2 * h / steps;
    }
    EXPECT_NEAR(integral, 1, 1e-6);
    EXPECT_EQ(paper::slope_over_r(2.01 * h, h), 0);
}

struct Cloud {
    Cloud()
        : config(closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, spacing, true)), boundary(config, {}, {}),
          particles(cloud(boundary, config, 0.2)) {
        set_walls(
            boundary, [](Vec2) { return 0.0; }, [](Vec2) { return 0.0; }, [](Vec2) { return 0.0; });
        for (std::size_t a = 0; a < particles.size(); ++a) {
            const Vec2 x = particles.position(a);
            particles.fields[a] = {
                std::sin(3 * x.x + x.y), x.x * x.y, 0.3 * x.x - x.y * x.y, std::cos(2 * x.y) + x.x};
        }
    }
    paper::Rates run(int threads) const {
        paper::Rates rates(spacing, threads);
        const Hydrostatics still(1, 0, {0, 0});
        rates.run(
            particles, boundary.grid(), boundary, Ghosts(spacing), still, material, volume, {});
        rates.compress(particles, material);
        return rates;
    }
    Config config;
    Boundary boundary;
    Particles particles;
    paper::Material material{1, 0.3, 0.7, 2, 30};
    double volume = spacing * spacing;
};

/// All sums over all pairs and all ghosts, written out; the velocities at the walls are zero, their
/// temperature too.
TEST(FluidPaper, SumsAreThoseOverAllPairsAndGhosts) {
    Cloud c;
    const paper::Rates rates = c.run(1);
    const Ghosts lattice(spacing);
    const double h = 1.2 * spacing, c2 = 900, eta2 = 0.01 * h * h, nu = 0.3, k = 0.7;
    std::vector<Contact> contacts;
    int beside_walls = 0;
    for (std::size_t a = 0; a < c.particles.size(); ++a) {
        const Vec2 x = c.particles.position(a);
        const Fields& f = c.particles.fields[a];
        const double rho = 1 + f.p / c2;
        // Neighbours and ghosts alike: visit(x_ab, fields of b, volume, 1 + d2/d1 of a ghost).
        const auto over_all = [&](const auto& visit) {
            for (std::size_t b = 0; b < c.particles.size(); ++b) {
                const Vec2 d = x - c.particles.position(b);
                if (b != a && norm(d) < 2 * h) {
                    visit(d, c.particles.fields[b], c.volume, 1.0);
                }
            }
            c.boundary.contacts(x, contacts);
            for (const Contact& wall : contacts) {
                lattice.for_each(wall, contacts, 2 * h, [&](Vec2 r, double d2, double V, double) {
                    const double q = d2 / std::max(wall.distance, 0.25 * spacing);
                    visit(-1.0 * r, Fields{-q * f.u, -q * f.v, f.p, -q * f.T}, V, 1 + q);
                });
            }
        };
        Mat2 M;
        over_all([&](Vec2 d, const Fields&, double V, double) {
            M += outer(-V * paper::slope_over_r(norm(d), h) * d, d);
        });
        const Mat2 L = inverse(M);
        Vec2 acceleration, shift;
        double warming = 0, rate = 0;
        over_all([&](Vec2 d, const Fields& g, double V, double) {
            const double rho_b = 1 + g.p / c2, r2 = dot(d, d), F = paper::slope_over_r(norm(d), h);
            const double m = V == c.volume ? V : rho_b * V; // of a ghost its density's
            const Vec2 gradient = L * (F * d), v{f.u - g.u, f.v - g.v};
            acceleration -= m * (f.p / (rho * rho) + g.p / (rho_b * rho_b)) * gradient;
            acceleration += 4 * m * nu * F * r2 / ((rho + rho_b) * (r2 + eta2)) * v;
            warming +=
                4 * m * k * k / (rho * rho_b * 2 * k) * (f.T - g.T) * F * r2 / (r2 + eta2) / 2;
            rate += rho * m / rho_b * dot(v, gradient);
            shift += V / c.volume / (r2 * norm(d)) * d;
        });
        beside_walls += contacts.empty() ? 0 : 1;
        // Terms of up to 1e3 in double precision; neighbours are the same set but for rounding.
        EXPECT_NEAR(rates.acceleration[a].x, acceleration.x, 1e-8);
        EXPECT_NEAR(rates.acceleration[a].y, acceleration.y, 1e-8);
        EXPECT_NEAR(rates.heating[a], warming, 1e-8);
        EXPECT_NEAR(rates.pressure_rate[a], c2 * rate, 1e-8 * c2);
        EXPECT_NEAR(rates.shift[a].x, shift.x, 1e-9 / (spacing * spacing));
        EXPECT_NEAR(rates.shift[a].y, shift.y, 1e-9 / (spacing * spacing));
    }
    EXPECT_GT(beside_walls, 30);
}

/// What the walls gave is what the particles gained, to rounding, whatever the fields.
TEST(FluidPaper, HeatOfThePairSumsIsTheWalls) {
    Cloud c;
    const paper::Rates rates = c.run(2);
    double gained = 0, given = 0;
    for (const double heating : rates.heating) {
        gained += c.material.density * c.volume * c.material.heat_capacity * heating;
    }
    for (const auto& chunk : rates.transfers) {
        for (const auto& transfer : chunk) {
            given += transfer.heat_flow;
        }
    }
    EXPECT_NEAR(gained, given, 1e-12 * std::abs(given));
    EXPECT_LT(given, -1) << "the fluid is warmer than its walls";
}

TEST(FluidPaper, WhatItHasNotIsRefused) {
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.1, false);
    config.formulation = Formulation::paper;
    config.sound_speed = 10;
    EXPECT_NO_THROW(Fluid{config});
    config.fourth_order = true;
    EXPECT_THROW(Fluid{config}, SceneError);
    config.fourth_order = false;
    config.walls = {{.name = "left", .from = {0, 0}, .to = {0, 1}, .slip = true}};
    EXPECT_THROW(Fluid{config}, SceneError);
}

TEST(FluidPaper, HeatFlowsFromHotToCold) {
    // The signs of (41) and (52) are for x . gradW < 0.
    const paper::Pair pair{{0.1, 0}, -5, 1, 1, 1, 0};
    EXPECT_LT(paper::heating(pair, 1, 1), 0) << "the warmer one cools";
    EXPECT_LT(paper::viscous_acceleration(pair, 1, {1, 0}).x, 0) << "the faster one slows";
    EXPECT_GT(paper::pressure_acceleration(pair, 1, 1, {-0.5, 0}).x, 0) << "pressure drives apart";
    EXPECT_EQ(paper::ghost_value(3.0, 1.0, 0.1, 0.2), 4.0);
}

} // namespace
} // namespace duet::fluid::test
