// The lowest frequency of a slender cantilever in plane strain.

#include "tests/unit/solid_support.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace duet::solid {
namespace {

using test::At;

constexpr double beam_length = 1, thickness = 0.1;

/// First frequency of a clamped-free Euler-Bernoulli beam, E' = E/(1 - nu^2).
double beam_frequency(const Material& m) {
    const double plane = m.youngs_modulus / (1 - m.poissons_ratio * m.poissons_ratio);
    return 1.875104 * 1.875104 / (beam_length * beam_length)
           * std::sqrt(plane * thickness * thickness / (12 * m.density));
}

/// First mode of the beam, one at the tip.
double mode(double x) {
    const double k = 1.875104 / beam_length, sigma = 0.734096;
    return 0.5
           * (std::cosh(k * x) - std::cos(k * x) - sigma * (std::sinh(k * x) - std::sin(k * x)));
}

/// Circular frequency from the time of the tip's first return, started in the mode's velocity.
double measured_frequency(Smoothing smoothing, int cells) {
    BodyConfig config =
        test::steel_like(rectangle_mesh({0, 0}, beam_length, thickness, thickness / cells));
    config.material.thermal_expansion = 0;
    config.smoothing = smoothing;
    config.boundary = {test::side(At::left, beam_length, thickness)};
    config.boundary[0].fixed_x = config.boundary[0].fixed_y = true;
    Body body(config);
    const auto v = test::nodal_vector(config.mesh,
                                      [](const Point& p) { return Point(0, 1e-6 * mode(p.x())); });
    body.mechanics()->set_motion(std::vector<double>(v.size(), 0.0), v, body.temperature());
    const std::size_t tip = body.nodes() - 1;
    const double dt = 0.9 * body.stable_step();
    const auto deflection = [&] {
        return body.position()[2 * tip + 1] - config.mesh.node[tip].y();
    };
    double time = 0, before = 0;
    do {
        before = deflection();
        body.step(dt);
        time += dt;
    } while (deflection() > 0);
    // The tip has crossed its place of rest after half a period, between two steps.
    const double half_period = time - dt * deflection() / (deflection() - before);
    return std::numbers::pi / half_period;
}

TEST(SolidCantilever, FrequencyAndTheSoftnessOfEdgeDomains) {
    const Material material = test::steel_like({}).material;
    // Shear and rotation lower it at this slenderness: two meshes of 8 and 16 elements through the
    // thickness, extrapolated, give 0.9938.
    const double expected = 0.9938 * beam_frequency(material);
    const double edge = measured_frequency(Smoothing::edge, 4) / expected - 1;
    const double element = measured_frequency(Smoothing::element, 4) / expected - 1;
    RecordProperty("edge", std::to_string(edge));
    RecordProperty("element", std::to_string(element));
    EXPECT_LT(std::abs(edge), 0.01); // with four elements through the thickness
    // T3 locks in bending; smoothing over edges is there to cure it.
    EXPECT_LT(8 * std::abs(edge), std::abs(element));
}

} // namespace
} // namespace duet::solid
