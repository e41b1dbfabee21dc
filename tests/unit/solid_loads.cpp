// Conditions that vary in place and time, prescribed motion, and bodies of two materials.

#include "solid_solver/conduction.hpp"
#include "solid_solver/loads.hpp"
#include "tests/unit/solid_support.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace duet::solid {
namespace {

using test::At;

Field of(double (*function)(double x, double y, double t)) {
    return Field([function](const Point& p, double t) { return function(p.x(), p.y(), t); });
}

BodyConfig square(BoundaryCondition condition) {
    BodyConfig config = test::steel_like(test::distorted_square(4));
    config.material.thermal_expansion = 0;
    config.boundary = {std::move(condition)};
    return config;
}

/// Sum of the forces, and their moment about the origin at `position`.
std::array<double, 3> resultant(const std::vector<double>& force,
                                const std::vector<double>& position) {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < force.size(); i += 2) {
        sum[0] += force[i];
        sum[1] += force[i + 1];
        sum[2] += position[i] * force[i + 1] - position[i + 1] * force[i];
    }
    return sum;
}

std::vector<double> forces(const BodyConfig& config, double time, const std::vector<double>& x) {
    const Loads loads(config, nodal_area(config.mesh));
    std::vector<double> force(x.size());
    loads.forces(time, x, force);
    return force;
}

TEST(SolidLoads, TractionThatIsLinearAlongTheBoundaryKeepsForceAndMoment) {
    BoundaryCondition right = test::side(At::right);
    right.traction = {of([](double, double y, double t) { return 3 * y * t; }), Field(2)};
    const BodyConfig config = square(right);
    const auto x = test::nodal_vector(config.mesh, [](const Point& p) { return p; });
    const auto sum = resultant(forces(config, 2, x), x);
    EXPECT_NEAR(sum[0], 3, 1e-14);
    EXPECT_NEAR(sum[1], 2, 1e-14);
    EXPECT_NEAR(sum[2], 2 - 2, 1e-14); // lever 1 of 2, less the integral of 6 y^2
}

TEST(SolidLoads, PressureFollowsTheBoundary) {
    BoundaryCondition top = test::side(At::top);
    top.pressure = 5;
    const BodyConfig config = square(top);
    // Turned by a right angle and stretched to twice its size: the top looks to the left.
    const auto x = test::nodal_vector(config.mesh,
                                      [](const Point& p) { return Point(-2 * p.y(), 2 * p.x()); });
    const auto sum = resultant(forces(config, 0, x), x);
    EXPECT_NEAR(sum[0], 10, 1e-13);
    EXPECT_NEAR(sum[1], 0, 1e-13);
    EXPECT_NEAR(sum[2], -10, 1e-13); // at the middle of the side, (-2, 1)
}

TEST(SolidLoads, PointLoadThatGrowsInTimeGivesItsImpulse) {
    BodyConfig config = square(test::side(At::left));
    config.point_load = {
        {"push", {0.98, 1.02}, {of([](double, double, double t) { return t; }), 0}}};
    Body body(config);
    body.advance(0.3);
    double momentum = 0;
    for (std::size_t i = 0; i < body.nodes(); ++i) {
        momentum += body.mechanics()->mass()[i] * body.velocity()[2 * i];
    }
    EXPECT_NEAR(momentum, 0.5 * 0.3 * 0.3, 1e-14);
}

TEST(SolidLoads, HeldBoundariesFollowWhatIsPrescribed) {
    BoundaryCondition left = test::side(At::left), right = test::side(At::right);
    left.velocity_x = of([](double, double, double t) { return 0.04 * t; });
    right.displacement_x =
        of([](double, double y, double t) { return 0.01 * y * std::sin(3 * t); });
    BodyConfig config = square(left);
    config.boundary.push_back(right);
    Body body(config);
    body.advance(0.5);
    body.advance(0.2);
    for (std::size_t i = 0; i < body.nodes(); ++i) {
        const Point& p = config.mesh.node[i];
        const double u = body.position()[2 * i] - p.x(), v = body.velocity()[2 * i];
        if (p.x() == 0) {
            EXPECT_NEAR(u, 0.02 * 0.7 * 0.7, 1e-14); // the midpoint rule is exact for it
            EXPECT_NEAR(v, 0.04 * 0.7, 1e-15);
        } else if (p.x() == 1) {
            EXPECT_NEAR(u, 0.01 * p.y() * std::sin(2.1), 1e-15);
            EXPECT_NEAR(v, 0.03 * p.y() * std::cos(2.1), 1e-9); // a difference quotient
        }
    }
}

TEST(SolidLoads, MotionToldTwiceIsRefused) {
    BoundaryCondition left = test::side(At::left);
    left.fixed_x = true;
    left.velocity_x = 1;
    EXPECT_THROW(Body{square(left)}, std::invalid_argument);
}

TEST(SolidLoads, TemperatureAndFluxFollowTheirFunctions) {
    BoundaryCondition left = test::side(At::left), right = test::side(At::right);
    left.temperature = of([](double, double y, double t) { return 300 + 10 * y * t; });
    right.heat_flux = of([](double, double y, double t) { return 4 * y * t; });
    BodyConfig config = square(left);
    config.motion = Motion::fixed;
    config.boundary.push_back(right);
    Body body(config);
    body.advance(0.5);
    for (std::size_t i = 0; i < body.nodes(); ++i) {
        const Point& p = config.mesh.node[i];
        if (p.x() == 0) {
            EXPECT_NEAR(body.temperature()[i], 300 + 5 * p.y(), 1e-12);
        }
    }
    // Rounding of 300 K in 25 nodes over some hundred steps.
    EXPECT_NEAR(body.heat().stored(), body.heat().account().walls, 1e-9);
    BodyConfig flux_alone = config;
    flux_alone.boundary.erase(flux_alone.boundary.begin());
    Body warmed(flux_alone);
    warmed.advance(0.5);
    EXPECT_NEAR(warmed.heat().account().walls, 2 * 0.5 * 0.5 * 0.5, 1e-14); // midpoint: exact
}

TEST(SolidLoads, PrescribedRigidMotionTurnsAboutItsCentre) {
    BodyConfig config = square({});
    config.boundary.clear();
    config.motion = Motion::prescribed;
    config.rigid_motion = {{2, 0},
                           {of([](double, double, double t) { return t; }), Field(0)},
                           of([](double, double, double t) { return 3 * t * t; })};
    Body body(config);
    EXPECT_FALSE(body.deformable());
    body.advance(0.4);
    const double angle = 0.48, speed = 2.4;
    for (std::size_t i = 0; i < body.nodes(); ++i) {
        const Point arm = config.mesh.node[i] - Point(2, 0);
        const Point turned(std::cos(angle) * arm.x() - std::sin(angle) * arm.y(),
                           std::sin(angle) * arm.x() + std::cos(angle) * arm.y());
        EXPECT_NEAR(body.position()[2 * i], 2.4 + turned.x(), 1e-14);
        EXPECT_NEAR(body.position()[2 * i + 1], turned.y(), 1e-14);
        EXPECT_NEAR(body.velocity()[2 * i], 1 - speed * turned.y(), 1e-6); // a difference quotient
        EXPECT_NEAR(body.velocity()[2 * i + 1], speed * turned.x(), 1e-6);
    }
}

/// The unit square, its right half of another part.
Mesh two_parts() {
    Mesh mesh = rectangle_mesh({0, 0}, 1, 1, 0.25);
    mesh.part_name = {"soft", "hard"};
    for (const Triangle& t : mesh.triangle) {
        const double x = (mesh.node[t[0]] + mesh.node[t[1]] + mesh.node[t[2]]).x() / 3;
        mesh.part.push_back(x > 0.5);
    }
    return mesh;
}

TEST(SolidParts, DomainsDoNotSpanTwoMaterials) {
    const Mesh mesh = two_parts();
    const Domains domains = make_domains(mesh, Smoothing::edge);
    std::array<double, 2> area{};
    for (std::size_t k = 0; k < domains.size(); ++k) {
        area[domains.part[k]] += domains.area[k];
    }
    EXPECT_NEAR(area[0], 0.5, 1e-14);
    EXPECT_NEAR(area[1], 0.5, 1e-14);
    // Four edges on the joint make two domains each.
    EXPECT_EQ(domains.size(), mesh_edges(mesh).size() + 4);
}

TEST(SolidParts, TensionThroughTwoMaterialsIsOneStress) {
    BodyConfig config = test::steel_like(two_parts());
    config.material.poissons_ratio = 0;
    config.material.thermal_expansion = 0;
    config.part_material = {config.material, config.material};
    config.part_material[1].youngs_modulus *= 7;
    config.boundary = {test::side(At::left), test::side(At::right), test::side(At::bottom)};
    config.boundary[0].fixed_x = config.boundary[2].fixed_y = true;
    config.boundary[1].traction = {0.3, 0};
    Body body(config);
    body.find_equilibrium(1e-13);
    for (std::size_t k = 0; k < body.domains().size(); ++k) {
        const PlaneTensor stress = body.mechanics()->domain_stress(k, body.temperature());
        EXPECT_NEAR(stress.xx, 0.3, 1e-12); // a mean over both materials would be off by tenths
        EXPECT_NEAR(stress.yy, 0, 1e-12);
    }
}

TEST(SolidParts, HeatFlowsThroughTwoMaterialsWithOneFlux) {
    const Mesh mesh = two_parts();
    const Conduction conduction(make_domains(mesh, Smoothing::edge), {2, 6});
    std::vector<double> temperature, out(mesh.node.size());
    for (const Point& p : mesh.node) {
        temperature.push_back(std::min(p.x(), 0.5) * 3 + std::max(p.x() - 0.5, 0.0));
    }
    const std::vector<double> none(out.size(), 0.0), one(out.size(), 1.0);
    conduction.advance(
        temperature.data(), none.data(), one.data(), out.data(), 0, mesh.node.size());
    double through = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double gain = out[i] - temperature[i];
        if (mesh.node[i].x() == 0) {
            through += gain;
        } else if (mesh.node[i].x() < 1) {
            EXPECT_NEAR(gain, 0, 1e-14);
        }
    }
    EXPECT_NEAR(through, 6, 1e-13); // 2 W/(m K) times 3 K/m over 1 m
}

} // namespace
} // namespace duet::solid
