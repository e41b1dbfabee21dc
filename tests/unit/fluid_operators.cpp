// The corrected gradient is exact for linear fields, the Laplacian for quadratic ones: on lattices,
// on disordered clouds, beside walls of known value and of known slope, and in corners.

#include "fluid_solver/wall_estimate.hpp"
#include "fluid_support.hpp"

#include <gtest/gtest.h>

namespace duet::fluid::test {
namespace {

constexpr double spacing = 0.1;
// Pairs and operators are in single precision: each of some 20 terms of a gradient or a Laplacian,
// of the size of the slopes below (4), over dx, is rounded to 6e-8 of itself in a few places.
constexpr double exact_slope = 5e-6;
constexpr double exact_laplacian = 2e-4;

struct Result {
    Particles particles;
    Evaluation evaluation{spacing, 1};
};

Result evaluate(Boundary& boundary,
                const Config& config,
                double disorder,
                const Field& u,
                const Field& v,
                const Field& T) {
    Result r;
    r.particles = cloud(boundary, config, disorder);
    set_fields(r.particles, u, v, T);
    set_walls(boundary, u, v, T);
    r.evaluation.run(
        r.particles, boundary.grid(), boundary, {spacing, spacing * spacing, 1, 1, 0, true});
    return r;
}

void expect_linear_exact(const std::vector<Vec2>& region, double disorder) {
    const Config config = closed(region, spacing, true);
    Boundary boundary(config, {}, {});
    const Result r = evaluate(
        boundary,
        config,
        disorder,
        [](Vec2 x) { return 1 + 2 * x.x - 3 * x.y; },
        [](Vec2 x) { return -2 + x.x + 0.5 * x.y; },
        [](Vec2 x) { return 5 - x.x + 4 * x.y; });
    for (std::size_t a = 0; a < r.particles.size(); ++a) {
        const Slope &gx = r.evaluation.slope_x[a], &gy = r.evaluation.slope_y[a];
        EXPECT_NEAR(gx.u, 2, exact_slope);
        EXPECT_NEAR(gy.u, -3, exact_slope);
        EXPECT_NEAR(gx.v, 1, exact_slope);
        EXPECT_NEAR(gy.v, 0.5, exact_slope);
        EXPECT_NEAR(gx.T, -1, exact_slope);
        EXPECT_NEAR(gy.T, 4, exact_slope);
        EXPECT_NEAR(r.evaluation.heating[a], 0, exact_laplacian);
        EXPECT_NEAR(r.evaluation.viscous[a].x, 0, exact_laplacian);
    }
}

TEST(FluidOperators, LinearFieldsInASquare) {
    expect_linear_exact({{0, 0}, {1.2, 0}, {1.2, 1}, {0, 1}}, 0);
    expect_linear_exact({{0, 0}, {1.2, 0}, {1.2, 1}, {0, 1}}, 0.25);
}

TEST(FluidOperators, LinearFieldsInATriangle) {
    expect_linear_exact({{0, 0}, {1.6, 0.2}, {0.5, 1.5}}, 0.2);
}

TEST(FluidOperators, LinearFieldsBesideAReentrantCorner) {
    expect_linear_exact({{0, 0}, {1.2, 0}, {1.2, 0.5}, {0.6, 0.5}, {0.6, 1.1}, {0, 1.1}}, 0.2);
}

TEST(FluidOperators, DivergenceOfTheInnerStepIsThatOfTheGradient) {
    // div v = sum (v_b - v_a).L gradW + value - v_a . L S must be the trace of the gradient.
    const Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, spacing, true);
    Boundary boundary(config, {}, {});
    const Result r = evaluate(
        boundary,
        config,
        0.2,
        [](Vec2 x) { return 1 + 2 * x.x - 3 * x.y; },
        [](Vec2 x) { return -2 + x.x + 0.5 * x.y; },
        [](Vec2) { return 0.0; });
    for (std::size_t a = 0; a < r.particles.size(); ++a) {
        const WallTerms* wall = r.evaluation.wall(a);
        const Correction& L = wall ? wall->L_velocity : r.evaluation.L[a];
        const Fields& own = r.particles.fields[a];
        double divergence = wall ? wall->value - dot({own.u, own.v}, wall->L_S) : 0;
        for (const PairBlock& block : r.evaluation.pairs(a)) {
            for (std::size_t k = 0; k < eight; ++k) {
                const Fields& other = r.particles.fields[block.index[k]];
                const Vec2 w{block.x[k], block.y[k]};
                divergence +=
                    dot({other.u - own.u, other.v - own.v}, Mat2{L.xx, L.xy, L.yx, L.yy} * w);
            }
        }
        EXPECT_NEAR(divergence, 2.5, exact_slope);
    }
}

/// Quadratic fields beside walls need wall values that are quadratic along the wall: one chain of
/// very short segments over the bottom and the left wall; particles that see others are left out.
struct FineCorner {
    Config config;
    std::vector<Chain> chains{{}};
    InterfaceState state;

    FineCorner() {
        config = closed({{0, 0}, {1.5, 0}, {1.5, 1.5}, {0, 1.5}}, spacing, true);
        const std::uint32_t count = 15000; // a segment: dx/1000, its sagitta 1e-7 dx^2
        const auto add = [&](Vec2 x) {
            chains[0].nodes.push_back(static_cast<std::uint32_t>(state.position.size()));
            state.position.push_back(x);
        };
        for (std::uint32_t i = 0; i < count; ++i) {
            add({1.5 - 1.5 * i / count, 0});
        }
        for (std::uint32_t i = 0; i <= count; ++i) {
            add({0, 1.5 * i / count});
        }
        state.velocity.resize(state.position.size());
        state.temperature.resize(state.position.size());
    }
};

void expect_quadratic_exact(const Field& f, double laplacian, double disorder) {
    FineCorner corner;
    Boundary boundary(corner.config, corner.chains, corner.state);
    const Result r = evaluate(boundary, corner.config, disorder, f, f, f);
    int counted = 0;
    for (std::size_t a = 0; a < r.particles.size(); ++a) {
        const Vec2 x = r.particles.position(a);
        if (x.x < 1.1 && x.y < 1.1) {
            ++counted;
            EXPECT_NEAR(r.evaluation.heating[a], laplacian, exact_laplacian) << x.x << ", " << x.y;
            EXPECT_NEAR(r.evaluation.viscous[a].x, laplacian, exact_laplacian)
                << x.x << ", " << x.y;
        }
    }
    EXPECT_GT(counted, 100);
}

TEST(FluidOperators, QuadraticFieldsOnALattice) {
    expect_quadratic_exact([](Vec2 x) { return x.x * x.x; }, 2, 0);
    expect_quadratic_exact([](Vec2 x) { return x.x * x.y; }, 0, 0);
    expect_quadratic_exact([](Vec2 x) { return 3 * x.y * x.y - x.x * x.y + x.x; }, 6, 0);
}

TEST(FluidOperators, QuadraticFieldsOnADisorderedCloud) {
    expect_quadratic_exact([](Vec2 x) { return x.x * x.x; }, 2, 0.1);
    expect_quadratic_exact([](Vec2 x) { return x.x * x.y; }, 0, 0.1);
    expect_quadratic_exact([](Vec2 x) { return 3 * x.y * x.y - x.x * x.y + x.x; }, 6, 0.1);
}

TEST(FluidOperators, QuadraticFieldBesideAnAdiabaticWall) {
    // T = y^2 - 2 x has no slope across the bottom; the velocity vanishes there.
    Config config = closed({{0, 0}, {1.5, 0}, {1.5, 1.5}, {0, 1.5}}, spacing, false);
    Boundary boundary(config, {}, {});
    for (const double disorder : {0.0, 0.1}) {
        const Result r = evaluate(
            boundary,
            config,
            disorder,
            [](Vec2 x) { return x.x * x.y; },
            [](Vec2) { return 0.0; },
            [](Vec2 x) { return x.y * x.y - 2 * x.x; });
        for (std::size_t a = 0; a < r.particles.size(); ++a) {
            const Vec2 x = r.particles.position(a);
            if (std::abs(x.x - 0.75) < 0.4 && x.y < 1.1) {
                EXPECT_NEAR(r.evaluation.heating[a], 2, exact_laplacian) << x.x << ", " << x.y;
                EXPECT_NEAR(r.evaluation.viscous[a].x, 0, exact_laplacian) << x.x << ", " << x.y;
            }
        }
    }
}

TEST(FluidOperators, QuadraticFieldBesideAWallThatSlips) {
    // u = y^2 - 2 x has no slope across the bottom, v = x y vanishes there; u is known on the left.
    Config config = closed({{0, 0}, {1.5, 0}, {1.5, 1.5}, {0, 1.5}}, spacing, false);
    config.walls = {{.name = "bottom", .from = {0, 0}, .to = {1.5, 0}, .slip = true}};
    Boundary boundary(config, {}, {});
    for (const double disorder : {0.0, 0.1}) {
        const Result r = evaluate(
            boundary,
            config,
            disorder,
            [](Vec2 x) { return x.y * x.y - 2 * x.x; },
            [](Vec2 x) { return x.x * x.y; },
            [](Vec2) { return 0.0; });
        for (std::size_t a = 0; a < r.particles.size(); ++a) {
            const Vec2 x = r.particles.position(a);
            if (std::abs(x.x - 0.75) < 0.4 && x.y < 1.1) {
                EXPECT_NEAR(r.evaluation.viscous[a].x, 2, exact_laplacian) << x.x << ", " << x.y;
                EXPECT_NEAR(r.evaluation.viscous[a].y, 0, exact_laplacian) << x.x << ", " << x.y;
            }
        }
    }
}

// On a lattice the Laplacian of x^4 is 12 x^2 + 24 (0.119 dx^2), and the second term goes with the
// Laplacians of the step before. Of T = x^4 y^4 less than a tenth is left of the error.
TEST(FluidOperators, FourthOrderInsideALattice) {
    const Config config = closed({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, spacing, true);
    const Boundary boundary(config, {}, {});
    Particles particles = cloud(boundary, config, 0);
    for (std::size_t a = 0; a < particles.size(); ++a) {
        const Vec2 x = particles.position(a);
        particles.fields[a] = {
            std::pow(x.x, 4), std::pow(x.y, 4), 0, std::pow(x.x, 4) * std::pow(x.y, 4)};
    }
    particles.sort(boundary.grid());
    Evaluation evaluation(spacing, 1);
    double plain = 0, corrected = 0, mixed_plain = 0, mixed = 0;
    for (int step = 0; step < 2; ++step) {
        EvaluationInput input{spacing, spacing * spacing, 1, 1, 0, true};
        input.fourth_order = true;
        particles.laplacian.resize(particles.size());
        evaluation.run(particles, boundary.grid(), boundary, input);
        particles.laplacian.swap(evaluation.laplacian);
        for (std::size_t a = 0; a < particles.size(); ++a) {
            const Vec2 x = particles.position(a);
            if (boundary.distance(x) < 2 * evaluation.kernel().support()) {
                continue; // its neighbours' Laplacians have no walls in them either
            }
            const double u = evaluation.viscous[a].x - 12 * x.x * x.x;
            const double v = evaluation.viscous[a].y - 12 * x.y * x.y;
            const double xx = x.x * x.x, yy = x.y * x.y;
            const double T = evaluation.heating[a] - 12 * xx * yy * (xx + yy);
            (step == 0 ? plain : corrected) =
                std::max({step == 0 ? plain : corrected, std::abs(u), std::abs(v)});
            (step == 0 ? mixed_plain : mixed) =
                std::max(step == 0 ? mixed_plain : mixed, std::abs(T));
        }
    }
    EXPECT_NEAR(plain, 24 * 0.119 * spacing * spacing, 2e-3);
    EXPECT_LT(corrected, 0.05 * plain);
    EXPECT_LT(mixed, 0.1 * mixed_plain);
}

/// The samples of the left wall of a unit square, away from its corners.
template <class Visit>
void for_left_samples(const Result& r, const Boundary& boundary, const Visit& visit) {
    int seen = 0;
    for (const auto& chunk : r.evaluation.samples) {
        for (const WallSample& sample : chunk) {
            const Vec2 x = r.particles.position(sample.particle);
            if (boundary.cells()[sample.cell].normal.x < -0.5 && std::abs(x.y - 0.5) < 0.2) {
                visit(sample);
                ++seen;
            }
        }
    }
    EXPECT_GT(seen, 4);
}

TEST(FluidOperators, DivergenceBesideAWallKnowsTheBendOfTheVelocity) {
    // u = -x^2/2, v = x (y - 1/2): nothing on the left wall and without divergence, but a gradient
    // that is exact for linear fields finds one in the first row.
    const Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, spacing, true);
    Boundary boundary(config, {}, {});
    Result r = evaluate(
        boundary,
        config,
        0.1,
        [](Vec2 x) { return -0.5 * x.x * x.x; },
        [](Vec2 x) { return x.x * (x.y - 0.5); },
        [](Vec2) { return 0.0; });
    WallEstimate estimate(spacing);
    estimate.slopes(boundary, r.evaluation, r.particles, {1, 1, 1, 1});
    const auto divergence = [&](std::size_t a) {
        return static_cast<double>(r.evaluation.slope_x[a].u + r.evaluation.slope_y[a].v)
               + r.evaluation.wall(a)->value;
    };
    double plain = 0;
    for_left_samples(r, boundary, [&](const WallSample& sample) {
        EXPECT_NEAR(estimate.bends()[sample.cell], 1, 0.1); // u_n,nn, n to the left
        plain = std::max(plain, std::abs(divergence(sample.particle)));
    });
    EXPECT_GT(plain, 0.1 * spacing);
    r.evaluation.correct_samples(std::vector<double>(boundary.cells().size(), 1),
                                 std::vector<double>(boundary.cells().size(), 0),
                                 1,
                                 1);
    for_left_samples(r, boundary, [&](const WallSample& sample) {
        EXPECT_NEAR(divergence(sample.particle), 0, exact_slope);
    });
}

TEST(FluidOperators, FourthOrderBesideAHeatedWall) {
    // T = 3 - 2 x + 5 x^4; in the second row only a part of its error is taken out.
    const double q = 5;
    const Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, spacing, true);
    Boundary boundary(config, {}, {});
    const auto zero = [](Vec2) { return 0.0; };
    Result r = evaluate(boundary, config, 0.1, zero, zero, [&](Vec2 x) {
        return 3 - 2 * x.x + q * std::pow(x.x, 4);
    });
    EvaluationInput input{spacing, spacing * spacing, 1, 1, 0, true};
    input.fourth_order = true;
    r.particles.laplacian.resize(r.particles.size());
    r.evaluation.run(r.particles, boundary.grid(), boundary, input);
    WallEstimate estimate(spacing);
    estimate.slopes(boundary, r.evaluation, r.particles, {1, 1, 1, 1});
    const auto error = [&](std::size_t a) {
        return r.evaluation.heating[a] - 12 * q * std::pow(r.particles.x[a], 2);
    };
    std::vector<double> plain(r.particles.size());
    double largest = 0;
    for_left_samples(r, boundary, [&](const WallSample& sample) {
        EXPECT_NEAR(estimate.quartics()[sample.cell], q, 0.2 * q);
        EXPECT_NEAR(estimate.loads()[sample.cell].heat_flux, 2, 0.002);
        plain[sample.particle] = error(sample.particle);
        largest = std::max(largest, std::abs(error(sample.particle)));
    });
    EXPECT_GT(largest, 0.1 * 24 * q * spacing * spacing);
    const std::size_t cells = boundary.cells().size();
    r.evaluation.correct_samples(
        std::vector<double>(cells, 0), std::vector<double>(cells, q), 1, 1);
    for_left_samples(r, boundary, [&](const WallSample& sample) {
        const double share = std::min(1.0, 2 * r.evaluation.sample_weight(sample.distance));
        EXPECT_NEAR(
            error(sample.particle), (1 - share) * plain[sample.particle], exact_laplacian * q);
    });
}

TEST(FluidOperators, TensorIsTheUnitTensorInsideALattice) {
    const Config config = closed({{0, 0}, {1.5, 0}, {1.5, 1.5}, {0, 1.5}}, spacing, true);
    Boundary boundary(config, {}, {});
    const Particles particles = cloud(boundary, config, 0);
    const Kernel kernel(support_in_spacings * spacing);
    std::size_t middle = 0;
    while (boundary.distance(particles.position(middle)) < kernel.support()) {
        ++middle;
    }
    const Vec2 x = particles.position(middle);
    const auto support = static_cast<float>(kernel.support());
    const CellGrid& grid = boundary.grid();
    static Surroundings surroundings;
    Neighbours near;
    ASSERT_TRUE(surroundings.collect(particles, grid, grid.column(x.x), grid.row(x.y)));
    ASSERT_TRUE(surroundings.find(x, support, near));
    near.pad(2 * support, static_cast<std::uint32_t>(middle));
    PairBlock pairs[most_neighbours / eight];
    DirectionWeights directions;
    OperatorBatch operators;
    operators.add(weigh(kernel, static_cast<float>(spacing * spacing), near, pairs, directions));
    operators.solve();
    EXPECT_NEAR(operators.L(0).xx, 1, 0.05); // the lattice's quadrature of int -F x x dV = 1
    EXPECT_NEAR(operators.L(0).xy, 0, 1e-6);
    EXPECT_NEAR(operators.B(0)[0], operators.B(0)[2], 1e-6);
    EXPECT_NEAR(operators.B(0)[1], 0, 1e-6);
    EXPECT_NEAR(operators.E(0)[0], 0, 1e-4); // of terms of the size of 1/dx
    EXPECT_NEAR(operators.E(0)[1], 0, 1e-4);
    EXPECT_FALSE(operators.limited(0));
}

} // namespace
} // namespace duet::fluid::test
