// How fast short elastic waves run on a mesh, with lumped and with corrected mass.

#include "tests/unit/solid_support.hpp"
#include "tests/verification/solid_order.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace duet::solid {
namespace {

using test::At;

/// Relative error of the frequency of u = sin(2 pi x) on the unit square with rollers all round,
/// `cells` elements a wave, from the time of the first return. Steps so small that they count
/// nothing.
double frequency_error(Mass mass, std::uint32_t cells) {
    BodyConfig config = test::steel_like(rectangle_mesh({0, 0}, 1, 1, 1.0 / cells));
    config.material.thermal_expansion = 0;
    config.mass = mass;
    config.boundary = {
        test::side(At::left), test::side(At::right), test::side(At::bottom), test::side(At::top)};
    config.boundary[0].fixed_x = config.boundary[1].fixed_x = true;
    config.boundary[2].fixed_y = config.boundary[3].fixed_y = true;
    const double k = 2 * std::numbers::pi;
    config.initial_velocity = {
        Field([=](const Point& p, double) { return 1e-6 * std::sin(k * p.x()); }, false), Field(0)};
    Body body(config);
    std::vector<double> shape;
    for (const Point& p : config.mesh.node) {
        shape.push_back(std::sin(k * p.x()));
    }
    const auto amplitude = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < shape.size(); ++i) {
            sum += shape[i] * body.mechanics()->displacement()[2 * i];
        }
        return sum;
    };
    const double dt = 0.05 * body.stable_step();
    double time = 0, before = 0, now = 0;
    do {
        before = now;
        body.step(dt);
        time += dt;
        now = amplitude();
    } while (now > 0);
    const double half_period = time - dt * now / (now - before);
    const Material& m = config.material;
    const double exact = k * std::sqrt((m.lambda() + 2 * m.mu()) / m.density);
    return std::numbers::pi / half_period / exact - 1;
}

TEST(SolidDispersion, CorrectedMassKeepsTheSpeedOfWaves) {
    std::vector<double> lumped, corrected;
    for (const std::uint32_t cells : {8u, 16u, 32u}) {
        lumped.push_back(std::abs(frequency_error(Mass::lumped, cells)));
        corrected.push_back(std::abs(frequency_error(Mass::corrected, cells)));
    }
    RecordProperty("lumped", std::to_string(lumped.back()));
    RecordProperty("corrected", std::to_string(1e6 * corrected.back()));
    // (kh)^2/12 with kh = 2 pi/32; the next order is a hundredth of it.
    EXPECT_NEAR(lumped.back(), std::pow(2 * std::numbers::pi / 32, 2) / 12, 1e-4);
    EXPECT_LT(corrected.back(), 0.03 * lumped.back());
    // Fourth order within, third from the rows where diagonals turn and the mesh ends.
    EXPECT_GT(test::fitted_order(corrected), 3);
}

TEST(SolidDispersion, CorrectionKeepsMomentumAndStability) {
    BodyConfig config = test::steel_like(test::distorted_square(6));
    config.mass = Mass::corrected;
    Body body(config);
    test::Noise noise;
    std::vector<double> velocity(2 * body.nodes());
    std::generate(velocity.begin(), velocity.end(), [&] { return 1e-3 * noise(); });
    body.mechanics()->set_motion(
        std::vector<double>(velocity.size(), 0.0), velocity, body.temperature());
    const auto momentum = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < body.nodes(); ++i) {
            sum += body.mechanics()->mass()[i] * body.velocity()[2 * i];
        }
        return sum;
    };
    const double start = momentum();
    for (int i = 0; i < 20000; ++i) {
        body.step(0.95 * body.stable_step());
    }
    EXPECT_NEAR(momentum(), start, 1e-13);
    double fastest = 0;
    for (const double v : body.velocity()) {
        fastest = std::max(fastest, std::abs(v));
    }
    EXPECT_LT(fastest, 0.02); // the start is 1e-3, spread over modes
}

} // namespace
} // namespace duet::solid
