// Conduction in a slab and a square that start at 1 and are held at 0 on their faces: the centre's
// temperature against the series, over three meshes.

#include "tests/unit/solid_support.hpp"
#include "tests/verification/solid_order.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace duet::solid {
namespace {

using test::At;

/// sum_n (4/pi) (-1)^n/(2n+1) exp(-(2n+1)^2 pi^2 Fo): the centre of a slab of unit thickness.
double slab(double fourier) {
    double sum = 0;
    for (int n = 0; n < 20; ++n) {
        const double m = 2 * n + 1;
        sum += 4 / std::numbers::pi * (n % 2 ? -1 : 1) / m
               * std::exp(-m * m * std::numbers::pi * std::numbers::pi * fourier);
    }
    return sum;
}

/// Errors of the centre's temperature at Fo = 0.05, 0.1, 0.2 with `cells` along a side.
std::array<double, 3> errors(int cells, bool square, Smoothing smoothing, Stepping stepping) {
    const double h = 1.0 / cells, height = square ? 1 : 2 * h;
    BodyConfig config;
    config.name = "block";
    config.mesh = rectangle_mesh({0, 0}, 1, height, h);
    config.smoothing = smoothing;
    config.stepping = stepping;
    config.material.conductivity = 1;
    config.initial_temperature = 1;
    config.boundary = {test::side(At::left, 1, height), test::side(At::right, 1, height)};
    if (square) {
        config.boundary.push_back(test::side(At::bottom));
        config.boundary.push_back(test::side(At::top));
    }
    for (BoundaryCondition& condition : config.boundary) {
        condition.temperature = 0;
    }
    Body body(config);
    const std::size_t centre = body.nodes() / 2;
    std::array<double, 3> result{};
    double time = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double fourier = std::array{0.05, 0.1, 0.2}[i];
        if (stepping == Stepping::implicit_steps) {
            // Of second order in time, with eight steps at least to the first time looked at.
            const double dt = 0.0625 * h;
            for (; time < fourier - 1e-9; time += dt) {
                body.advance(dt);
            }
        }
        // dt = h2/10, within the bound of either kind of domain: time and space errors fall alike.
        for (; time < fourier - 1e-9; time += 0.1 * h * h) {
            body.step(0.1 * h * h);
        }
        const double exact = square ? slab(fourier) * slab(fourier) : slab(fourier);
        result[i] = std::abs(body.temperature()[centre] - exact);
    }
    return result;
}

TEST(SolidConductionOrder, SeriesAgreesWithThePublishedValues) {
    EXPECT_NEAR(slab(0.05), 0.772312, 5e-7);
    EXPECT_NEAR(slab(0.1) * slab(0.1), 0.225138, 5e-7);
    EXPECT_NEAR(slab(0.2) * slab(0.2), 0.031282, 5e-7);
}

class Conduction : public testing::TestWithParam<std::tuple<bool, Smoothing, Stepping>> {};

TEST_P(Conduction, IsOfSecondOrder) {
    const auto [square, smoothing, stepping] = GetParam();
    // Implicit steps have no error of first order to go with that of the mesh, which in the
    // square's centre, where the diagonals meet, falls with its square from 20 cells on.
    const int coarsest = square && stepping == Stepping::implicit_steps ? 20 : 10;
    std::array<std::array<double, 3>, 3> error;
    for (std::size_t level = 0; level < 3; ++level) {
        error[level] = errors(coarsest << level, square, smoothing, stepping);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const double order = test::fitted_order({error[0][i], error[1][i], error[2][i]});
        RecordProperty("order_" + std::to_string(i), std::to_string(order));
        EXPECT_GE(order, 1.9) << "errors " << error[0][i] << ' ' << error[1][i] << ' '
                              << error[2][i];
        EXPECT_LT(error[2][i], 6e-4); // of 1, at 40 cells or more
    }
}

// Plain T3 is held to the slab alone: the square's centre, where the diagonals meet, has another
// share of lumped capacity than its neighbours, and the five-point stencil of T3 falls back there.
INSTANTIATE_TEST_SUITE_P(
    SlabAndSquare,
    Conduction,
    testing::Values(std::tuple{false, Smoothing::edge, Stepping::explicit_steps},
                    std::tuple{true, Smoothing::edge, Stepping::explicit_steps},
                    std::tuple{false, Smoothing::element, Stepping::explicit_steps},
                    std::tuple{false, Smoothing::edge, Stepping::implicit_steps},
                    std::tuple{true, Smoothing::edge, Stepping::implicit_steps}));

} // namespace
} // namespace duet::solid
