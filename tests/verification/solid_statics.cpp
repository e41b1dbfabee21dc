// Static answers that are known from elsewhere: Cook's membrane, the elastica, the bar of Turek and
// Hron under its weight, warmed strips.

#include "tests/verification/solid_statics.hpp"

#include "tests/verification/solid_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace duet::solid {
namespace {

using namespace test;

TEST(SolidStatics, CooksMembrane) {
    const auto error = [](std::uint32_t n, Smoothing smoothing) {
        return std::abs(cook_deflection(n, smoothing) / 21.52 - 1);
    };
    const double edge16 = error(16, Smoothing::edge), edge32 = error(32, Smoothing::edge);
    RecordProperty("edge16", std::to_string(edge16));
    RecordProperty("edge32", std::to_string(edge32));
    EXPECT_LT(edge16, 0.02);
    EXPECT_LT(edge32, 0.007);
    EXPECT_GT(error(16, Smoothing::element), 3 * edge16);
    EXPECT_GT(error(32, Smoothing::element), 3 * edge32);
}

/// Tip of a cantilever of length 1 bent by a dead load a E' I / L^2: shortening and deflection.
Point elastica(double a) {
    constexpr double height = 0.02;
    BodyConfig config = elastic(rectangle_mesh({0, 0}, 1, height, height / 6), 1, 0.3);
    const double bending = 1 / (1 - 0.09) * height * height * height / 12;
    config.boundary = {clamp("left"), on_curve("right")};
    config.boundary[1].traction = {0, a * bending / height};
    Body body(config);
    body.find_equilibrium(1e-9);
    const Point tip = displacement_at(body, {1, height / 2});
    return {-tip.x(), tip.y()};
}

TEST(SolidStatics, Elastica) {
    // Exact inextensible rod; six edge-smoothed elements through the thickness are 0.3 % stiff.
    const Point one = elastica(1), two = elastica(2), ten = elastica(10);
    RecordProperty("one", std::to_string(one.y() / 0.30172 - 1));
    RecordProperty("two", std::to_string(two.y() / 0.49346 - 1));
    RecordProperty("ten", std::to_string(ten.y() / 0.81061 - 1));
    EXPECT_NEAR(one.y() / 0.30172, 1, 0.01);
    EXPECT_NEAR(one.x() / 0.05643, 1, 0.02); // of second order in the deflection
    EXPECT_NEAR(two.y() / 0.49346, 1, 0.01);
    EXPECT_NEAR(two.x() / 0.16064, 1, 0.01);
    EXPECT_NEAR(ten.y() / 0.81061, 1, 0.01);
    EXPECT_NEAR(ten.x() / 0.55500, 1, 0.01);
}

/// The bar of Turek and Hron under its weight (CSM1): displacement of its tip.
Point hanging_bar(std::uint32_t through) {
    Mesh mesh = rectangle_mesh({0, 0}, 0.35, 0.02, 0.02 / through);
    for (Point& p : mesh.node) { // its left end is a piece of the circle round (0.2, 0.2)
        const double y = 0.19 + p.y(), left = 0.2 + std::sqrt(0.0025 - (y - 0.2) * (y - 0.2));
        p = {left + p.x() / 0.35 * (0.6 - left), y};
    }
    BodyConfig config = elastic(std::move(mesh), 1.4e6, 0.4);
    config.material.density = 1000;
    config.body_force = {0, -2};
    config.boundary = {clamp("left")};
    Body body(config);
    body.find_equilibrium(1e-9);
    return displacement_at(body, {0.6, 0.2});
}

TEST(SolidStatics, BarOfTurekAndHronUnderItsWeight) {
    const Point coarse = hanging_bar(4), fine = hanging_bar(8);
    RecordProperty("coarse", std::to_string(coarse.y() / -66.10e-3 - 1));
    RecordProperty("fine", std::to_string(fine.y() / -66.10e-3 - 1));
    EXPECT_NEAR(fine.y() / -66.10e-3, 1, 0.01);
    EXPECT_NEAR(fine.x() / -7.187e-3, 1, 0.02); // of second order in the deflection
    EXPECT_LT(std::abs(fine.y() + 66.10e-3), 0.5 * std::abs(coarse.y() + 66.10e-3));
}

/// A strip 1 x 0.1 with T = G y, y from its middle: error of the tip's deflection and the largest
/// stress, relative to what a held strip would have.
std::array<double, 2> warmed_strip(std::uint32_t through) {
    constexpr double gradient = 1e-4, height = 0.1;
    BodyConfig config = steel_like(rectangle_mesh({0, -height / 2}, 1, height, height / through));
    config.reference_temperature = 0;
    config.initial_temperature =
        Field([](const Point& p, double) { return gradient * p.y(); }, false);
    const double curvature =
        (1 + config.material.poissons_ratio) * config.material.thermal_expansion * gradient;
    config.boundary = {on_curve("left")};
    config.boundary[0].fixed_x = true;
    config.boundary[0].displacement_y =
        Field([=](const Point& p, double) { return 0.5 * curvature * p.y() * p.y(); }, false);
    Body body(config);
    body.find_equilibrium(1e-12);
    const double tip = displacement_at(body, {1, 0}).y();
    double stress = 0;
    for (std::size_t k = 0; k < body.domains().size(); ++k) {
        const PlaneTensor s = body.mechanics()->domain_stress(k, body.temperature());
        stress = std::max({stress, std::abs(s.xx), std::abs(s.yy), std::abs(s.xy)});
    }
    // Warmer above bends it downwards, and more there is to hold at the top and bottom.
    return {std::abs(tip / (-0.5 * curvature) - 1),
            stress / (config.material.beta() * gradient * height / 2)};
}

TEST(SolidStatics, WarmedStripBendsFreeOfStress) {
    std::vector<double> deflection, stress;
    for (const std::uint32_t through : {2u, 4u, 8u}) {
        const auto [tip, largest] = warmed_strip(through);
        deflection.push_back(tip);
        stress.push_back(largest);
    }
    RecordProperty("deflection", std::to_string(deflection.back()));
    RecordProperty("stress", std::to_string(stress.back()));
    EXPECT_LT(deflection.back(), 0.01);
    EXPECT_GT(fitted_order(deflection), 1.8);
    // A temperature that is linear in each element against a strain that is constant in each.
    EXPECT_GT(fitted_order(stress), 0.8);
}

TEST(SolidStatics, BimaterialStripBends) {
    constexpr double height = 0.1;
    BodyConfig config = elastic(rectangle_mesh({0, 0}, 2, height, height / 16), 200, 0.3);
    config.mesh.part_name = {"stiff", "soft"};
    for (const Triangle& t : config.mesh.triangle) {
        const Point sum = config.mesh.node[t[0]] + config.mesh.node[t[1]] + config.mesh.node[t[2]];
        config.mesh.part.push_back(sum.y() > 1.5 * height);
    }
    config.material.thermal_expansion = 1e-4;
    config.part_material = {config.material, config.material};
    config.part_material[1].youngs_modulus = 100;
    config.part_material[1].thermal_expansion = 2e-4;
    config.initial_temperature = 0.01; // a thousandth of the reference's 10 K: small strains
    BoundaryCondition corner;
    corner.name = "corner";
    corner.to = {height / 16, 0};
    corner.fixed_y = true;
    config.boundary = {on_curve("left"), corner};
    config.boundary[0].fixed_x = true; // the middle of a longer strip
    Body body(config);
    body.find_equilibrium(1e-12);
    const auto v = [&](double x) { return displacement_at(body, {x, height / 2}).y(); };
    const double curvature = -(v(1.5) - 2 * v(1) + v(0.5)) / 0.25;
    RecordProperty("error", std::to_string(curvature / 0.0189091e-3 - 1));
    EXPECT_NEAR(curvature / 0.0189091e-3, 1, 0.005); // sixteen elements through the thickness
}

} // namespace
} // namespace duet::solid
