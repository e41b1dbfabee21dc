// The corrected gradient is exact for linear fields, the Laplacian for quadratic ones: on lattices,
// on disordered clouds, beside walls of known value and of known slope, and in corners.

#include "fluid_support.hpp"

#include <gtest/gtest.h>

namespace duet::fluid::test {
namespace {

constexpr double spacing = 0.1;
// The pair weights are rounded to float but enter all sums alike: linear fields are exact to
// double.
constexpr double exact = 1e-11;
// Third moments use the unrounded products: 1e-7 of 4/dx^2.
constexpr double nearly_exact = 1e-4;

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
        const Fields &gx = r.evaluation.slope_x[a], &gy = r.evaluation.slope_y[a];
        EXPECT_NEAR(gx.u, 2, exact);
        EXPECT_NEAR(gy.u, -3, exact);
        EXPECT_NEAR(gx.v, 1, exact);
        EXPECT_NEAR(gy.v, 0.5, exact);
        EXPECT_NEAR(gx.T, -1, exact);
        EXPECT_NEAR(gy.T, 4, exact);
        EXPECT_NEAR(r.evaluation.heating[a], 0, exact / (spacing * spacing));
        EXPECT_NEAR(r.evaluation.viscous[a].x, 0, exact / (spacing * spacing));
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
        const bool walled = r.evaluation.near_wall[a];
        const Mat2 L = walled ? r.evaluation.wall[a].L_velocity : r.evaluation.L[a];
        const Fields& own = r.particles.fields[a];
        double divergence =
            walled ? r.evaluation.wall[a].value - dot({own.u, own.v}, r.evaluation.wall[a].L_S) : 0;
        for (std::size_t k = 0; k < r.evaluation.count[a]; ++k) {
            const PairWeight& pair = r.evaluation.pairs(a)[k];
            const Fields& other = r.particles.fields[pair.index];
            divergence += dot({other.u - own.u, other.v - own.v},
                              L * Vec2{static_cast<double>(pair.x), static_cast<double>(pair.y)});
        }
        EXPECT_NEAR(divergence, 2.5, exact);
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
            EXPECT_NEAR(r.evaluation.heating[a], laplacian, nearly_exact) << x.x << ", " << x.y;
            EXPECT_NEAR(r.evaluation.viscous[a].x, laplacian, nearly_exact) << x.x << ", " << x.y;
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
                EXPECT_NEAR(r.evaluation.heating[a], 2, nearly_exact) << x.x << ", " << x.y;
                EXPECT_NEAR(r.evaluation.viscous[a].x, 0, nearly_exact) << x.x << ", " << x.y;
            }
        }
    }
}

TEST(FluidOperators, TensorIsTheUnitTensorInsideALattice) {
    const Config config = closed({{0, 0}, {1.5, 0}, {1.5, 1.5}, {0, 1.5}}, spacing, true);
    Boundary boundary(config, {}, {});
    const Particles particles = cloud(boundary, config, 0);
    const Kernel kernel(support_in_spacings * spacing);
    Neighbours near;
    Weights weights;
    std::size_t middle = 0;
    while (boundary.distance(particles.position(middle)) < kernel.support()) {
        ++middle;
    }
    ASSERT_TRUE(find_neighbours(particles, boundary.grid(), kernel.support(), middle, near));
    weigh(kernel, spacing * spacing, near, weights);
    const Moments m = moments(near, weights);
    const Mat2 L = correction(m, {});
    const LaplacianTensor t = laplacian_tensor(m, gradient_error(m, L, {}), {});
    EXPECT_NEAR(L.xx, 1, 0.05); // the lattice's quadrature of int -F x x dV = 1
    EXPECT_NEAR(L.xy, 0, 1e-6);
    EXPECT_NEAR(t.B[0], t.B[2], 1e-6);
    EXPECT_NEAR(t.B[1], 0, 1e-6);
    EXPECT_NEAR(norm(t.E), 0, 1e-5);
    EXPECT_FALSE(t.limited);
}

} // namespace
} // namespace duet::fluid::test
