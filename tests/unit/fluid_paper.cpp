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
    Config config;
    Boundary boundary;
    Particles particles;
    paper::Material material{1, 0.3, 0.7, 2, 30};
    double volume = spacing * spacing;
};

/// All sums over all pairs, for the particles that see no wall.
TEST(FluidPaper, SumsOverNeighboursAreThoseOverAllPairs) {
    Cloud c;
    paper::Rates rates(spacing, 1);
    const Hydrostatics still(1, 0, {0, 0});
    rates.run(c.particles,
              c.boundary.grid(),
              c.boundary,
              Ghosts(spacing),
              still,
              c.material,
              c.volume,
              {});
    rates.compress(c.particles, c.material);
    const double h = 1.2 * spacing, c2 = 900;
    int compared = 0;
    for (std::size_t a = 0; a < c.particles.size(); ++a) {
        const Vec2 x = c.particles.position(a);
        if (c.boundary.distance(x) < 2.7 * spacing) {
            continue;
        }
        ++compared;
        const Fields& f = c.particles.fields[a];
        const double rho = 1 + f.p / c2;
        Mat2 M;
        for (std::size_t b = 0; b < c.particles.size(); ++b) {
            const Vec2 d = x - c.particles.position(b);
            const double F = b == a ? 0 : paper::slope_over_r(norm(d), h);
            M += outer(-c.volume * F * d, d);
        }
        const Mat2 L = inverse(M);
        Vec2 acceleration, shift;
        double warming = 0, density = 0;
        for (std::size_t b = 0; b < c.particles.size(); ++b) {
            const Vec2 d = x - c.particles.position(b);
            if (b == a || norm(d) >= 2 * h) {
                continue;
            }
            const Fields& g = c.particles.fields[b];
            const double rho_b = 1 + g.p / c2, m = c.volume, r2 = dot(d, d), eta2 = 0.01 * h * h;
            const double F = paper::slope_over_r(norm(d), h);
            const Vec2 gradient = L * (F * d), v{f.u - g.u, f.v - g.v};
            acceleration -= m * (f.p / (rho * rho) + g.p / (rho_b * rho_b)) * gradient;
            acceleration += 4 * m * 0.3 * F * r2 / ((rho + rho_b) * (r2 + eta2)) * v;
            warming +=
                4 * m * 0.7 * 0.7 / (rho * rho_b * 1.4) * (f.T - g.T) * F * r2 / (r2 + eta2) / 2;
            density += rho * m / rho_b * dot(v, gradient);
            shift += 1 / (r2 * norm(d)) * d;
        }
        EXPECT_NEAR(rates.acceleration[a].x, acceleration.x, 1e-9);
        EXPECT_NEAR(rates.acceleration[a].y, acceleration.y, 1e-9);
        EXPECT_NEAR(rates.heating[a], warming, 1e-9);
        EXPECT_NEAR(rates.pressure_rate[a], c2 * density, 1e-9 * c2);
        EXPECT_NEAR(rates.shift[a].x, shift.x, 1e-9 / (spacing * spacing));
    }
    EXPECT_GT(compared, 10);
}

/// What the walls gave is what the particles gained, to rounding, whatever the fields.
TEST(FluidPaper, HeatOfThePairSumsIsTheWalls) {
    Cloud c;
    paper::Rates rates(spacing, 2);
    const Hydrostatics still(1, 0, {0, 0});
    rates.run(c.particles,
              c.boundary.grid(),
              c.boundary,
              Ghosts(spacing),
              still,
              c.material,
              c.volume,
              {});
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
