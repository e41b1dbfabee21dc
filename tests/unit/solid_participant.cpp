// The solid as the protocol sees it: scene in, chains, motion, ledger, probes and files out.

#include "solid_solver/solid_participant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace duet::solid {
namespace {

class SolidParticipant : public testing::Test {
  protected:
    SolidParticipant() {
        folder_ = std::filesystem::path(testing::TempDir())
                  / ("solid_"
                     + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::create_directories(folder_);
        configure_.set_run_folder(folder_.string());
        configure_.set_threads(1);
        v1::Scene& scene = *configure_.mutable_scene();
        scene.mutable_fluid()->set_spacing(0.2);
        scene.mutable_fluid()->set_density(1);
        scene.mutable_fluid()->set_conductivity(0.5);
        for (const auto& [x, y] : {std::pair{0, 0}, {4, 0}, {4, 3}, {0, 3}}) {
            v1::Vector& corner = *scene.mutable_fluid()->add_region();
            corner.set_x(x);
            corner.set_y(y);
        }
        add_body("plate", 0.5, v1::Body::FIXED);
    }
    ~SolidParticipant() override { std::filesystem::remove_all(folder_); }

    v1::Body& add_body(const std::string& name, double x, v1::Body::Motion motion) {
        v1::Body& body = *configure_.mutable_scene()->mutable_solid()->add_body();
        body.set_name(name);
        body.mutable_rectangle()->mutable_corner()->set_x(x);
        body.mutable_rectangle()->mutable_corner()->set_y(1);
        body.mutable_rectangle()->set_width(1);
        body.mutable_rectangle()->set_height(1);
        body.set_element_size(0.1);
        body.set_motion(motion);
        body.set_density(2);
        body.set_heat_capacity(3);
        body.set_conductivity(0.7);
        body.set_youngs_modulus(5);
        body.set_poissons_ratio(0.3);
        body.set_thermal_expansion(1e-4);
        body.mutable_initial_temperature()->set_number(400);
        body.set_thermoelastic_heating(true);
        return body;
    }

    v1::Probe& add_probe(const std::string& name, const std::string& quantity) {
        v1::Probe& probe = *configure_.mutable_scene()->add_probe();
        probe.set_name(name);
        probe.set_of(v1::Probe::SOLID);
        probe.set_quantity(quantity);
        return probe;
    }

    void configure() { solid_.configure(configure_, ready_, chains_, motion_); }

    std::string refusal() {
        try {
            configure();
        } catch (const protocol::Error& error) {
            EXPECT_EQ(error.code(), v1::Failed::SCENE);
            return error.what();
        }
        return "";
    }

    /// A window of `length` with `flow` W/m into each segment and (fx, 0) on each node.
    v1::Report advance(double length, double flow, double fx) {
        protocol::InterfaceLoad load;
        load.length = length;
        load.heat_flow.assign(ready_.segments(), flow);
        for (std::size_t i = 0; i < ready_.nodes(); ++i) {
            load.force.insert(load.force.end(), {fx, 0.0});
        }
        v1::Report report;
        solid_.advance({windows_++, motion_.time, length, true, true}, load, motion_, report);
        return report;
    }

    static double value(const google::protobuf::RepeatedPtrField<v1::Sample>& samples,
                        const std::string& probe) {
        for (const v1::Sample& sample : samples) {
            if (sample.probe() == probe) {
                return sample.value(0);
            }
        }
        return std::nan("");
    }

    std::filesystem::path folder_;
    v1::Configure configure_;
    v1::Ready ready_;
    std::vector<protocol::Chain> chains_;
    protocol::InterfaceMotion motion_;
    Participant solid_;
    std::uint64_t windows_ = 0;
};

TEST_F(SolidParticipant, ReadyTellsTheInterfaceAndTheLimit) {
    configure();
    ASSERT_EQ(chains_.size(), 1u);
    EXPECT_TRUE(chains_[0].closed);
    EXPECT_EQ(ready_.nodes(), 40u);
    EXPECT_EQ(ready_.segments(), 40u);
    EXPECT_EQ(ready_.unknowns(), 121u);
    // rho c dx_s/2 (dx/2) / (2 k_f): the exchange, not the own step, limits the window.
    EXPECT_NEAR(ready_.stable_step(), 2 * 3 * 0.05 * 0.1 / 0.5 / 2, 1e-14);
    EXPECT_EQ(motion_.nodes(), 40u);
    EXPECT_EQ(motion_.temperature[7], 400);
    EXPECT_EQ(motion_.position[0], 0.5);
    EXPECT_EQ(motion_.velocity.size(), 80u);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "solid.h5"));
    EXPECT_NEAR(ready_.ledger().mass(), 2, 1e-14);
}

TEST_F(SolidParticipant, AnInsulatedBodySaysSoOfItsChains) {
    add_body("shielded", 2.5, v1::Body::FIXED).set_insulated(true);
    configure();
    ASSERT_EQ(chains_.size(), 2u);
    EXPECT_FALSE(chains_[0].insulated);
    EXPECT_TRUE(chains_[1].insulated);
}

TEST_F(SolidParticipant, LedgerBooksWhatCameIn) {
    configure();
    const v1::Report report = advance(0.25, -3, 0.01);
    const v1::Ledger& ledger = report.ledger();
    EXPECT_NEAR(ledger.heat_from_interface(), -3 * 40 * 0.25, 1e-12);
    EXPECT_NEAR(ledger.heat(), -3 * 40 * 0.25, 1e-10); // rounding of 400 K in 121 nodes
    EXPECT_NEAR(ledger.exchanged_heat(), 3 * 40 * 0.25, 1e-12);
    EXPECT_NEAR(ledger.impulse_x(), 0.01 * 40 * 0.25, 1e-14); // on a fixed body too
    EXPECT_EQ(ledger.work(), 0);
    EXPECT_EQ(motion_.time, 0.25);
    EXPECT_LT(motion_.temperature[0], 400);
    EXPECT_GE(report.steps(), 1u);
}

TEST_F(SolidParticipant, ADeformableBodyMovesItsInterface) {
    configure_.mutable_scene()->mutable_solid()->mutable_body(0)->set_motion(v1::Body::DEFORMABLE);
    configure();
    const std::vector<double> start = motion_.position;
    const v1::Report report = advance(0.25, 0, 0.01);
    EXPECT_GT(motion_.position[0], 0.5);
    EXPECT_GT(motion_.velocity[0], 0);
    EXPECT_GT(report.ledger().work(), 0);
    double way = 0; // of all nodes together
    for (std::size_t i = 0; i < motion_.nodes(); ++i) {
        way += motion_.position[2 * i] - start[2 * i];
    }
    EXPECT_NEAR(report.ledger().work(), 0.01 * way, 1e-14 * way);
    EXPECT_GT(report.ledger().kinetic_energy(), 0);
    EXPECT_GT(report.ledger().strain_energy(), 0);
}

TEST_F(SolidParticipant, ARigidBodyIsMovedByTheLoadsOfItsInterface) {
    v1::Body& body = *configure_.mutable_scene()->mutable_solid()->mutable_body(0);
    body.set_motion(v1::Body::RIGID);
    body.mutable_support()->set_fixed_y(true);
    body.mutable_support()->set_spring_x(7);
    add_probe("turn", "angle");
    configure();
    const v1::Report report = advance(0.25, -3, 0.01);
    // M x'' = F - k x: M = 2, F = 0.4.
    const double frequency = std::sqrt(3.5), phase = 0.25 * frequency;
    const double way = 0.4 / 7 * (1 - std::cos(phase));
    EXPECT_NEAR(motion_.position[0], 0.5 + way, 3e-4 * way); // w dt = 0.05: twice its square/24
    EXPECT_NEAR(motion_.velocity[0], 0.4 / 7 * frequency * std::sin(phase), 1e-5);
    EXPECT_NEAR(motion_.velocity[1], 0, 1e-15);
    EXPECT_NEAR(report.ledger().work(), 0.4 * way, 3e-4 * 0.4 * way);
    EXPECT_NEAR(report.ledger().strain_energy(), 0.5 * 7 * way * way, 1e-3 * 3.5 * way * way);
    EXPECT_NEAR(report.ledger().kinetic_energy() + report.ledger().strain_energy(),
                report.ledger().work(),
                1e-3 * report.ledger().work());
    EXPECT_NEAR(report.ledger().heat(), -3 * 40 * 0.25, 1e-10); // and it takes the heat
    EXPECT_NEAR(value(report.sample(), "turn"), 0, 1e-14);
}

TEST_F(SolidParticipant, ProbesOfABoundaryTakeItsReactionAndItsHeat) {
    v1::Body& body = *configure_.mutable_scene()->mutable_solid()->mutable_body(0);
    body.set_motion(v1::Body::DEFORMABLE);
    body.set_thermal_expansion(0);
    body.set_stiffness_damping(0.1);
    const auto add = [&](const std::string& curve) -> v1::Boundary& {
        v1::Boundary& boundary = *body.add_boundary();
        boundary.set_name(curve + " side");
        boundary.set_curve(curve);
        return boundary;
    };
    add("left").set_fixed_x(true);
    add("bottom").set_fixed_y(true);
    v1::Boundary& right = add("right");
    right.mutable_traction()->mutable_x()->set_number(0.01);
    right.mutable_heat_flux()->set_number(6);
    body.mutable_boundary(0)->mutable_temperature()->set_number(400);
    v1::Boundary& top = add("top");
    top.mutable_convection()->set_coefficient(2);
    top.mutable_convection()->mutable_temperature()->set_number(500);
    for (const auto& [name, quantity, boundary] : {std::tuple{"pull", "reaction_x", "left side"},
                                                   {"lift", "reaction_y", "bottom side"},
                                                   {"none", "reaction_x", "right side"},
                                                   {"in", "heat_flow", "right side"},
                                                   {"out", "heat_flow", "left side"},
                                                   {"wind", "heat_flow", "top side"},
                                                   {"work", "work_of_loads", ""},
                                                   {"lost", "dissipated", ""},
                                                   {"wrong", "energy_residual", ""}}) {
        add_probe(name, quantity).set_boundary(boundary);
    }
    configure();
    EXPECT_NEAR(value(ready_.sample(), "wind"), 2 * 100, 1e-10);
    v1::Report report;
    for (int i = 0; i < 40; ++i) {
        report = advance(1, 0, 0);
    }
    const auto of = [&](const char* name) { return value(report.sample(), name); };
    EXPECT_NEAR(of("pull"), -0.01, 1e-6); // at rest but for exp(-13)
    EXPECT_NEAR(of("lift"), 0, 1e-6);
    EXPECT_EQ(of("none"), 0);
    EXPECT_NEAR(of("in"), 6, 1e-13);
    EXPECT_NEAR(of("out") + of("in") + of("wind"), 0, 1e-2); // steady
    EXPECT_LT(of("out"), -6);
    // A load put on at once does twice the work that is stored in the end; the rest is lost.
    const double stored = report.ledger().strain_energy();
    EXPECT_NEAR(of("work"), 2 * stored, 1e-2 * stored); // strains of 2e-3
    EXPECT_NEAR(of("lost"), stored, 1e-2 * stored);
    EXPECT_NEAR(of("wrong"), 0, 1e-5 * stored); // of second order in the step: 1e-6 measured
    EXPECT_EQ(report.ledger().figure().at("dissipated"), of("lost"));
    add_probe("other", "heat_flow").set_boundary("roof");
    EXPECT_NE(refusal().find("which no body has"), std::string::npos);
}

TEST_F(SolidParticipant, AProbeTakesTheDifferenceAlongALine) {
    v1::Boundary& hot =
        *configure_.mutable_scene()->mutable_solid()->mutable_body(0)->add_boundary();
    hot.set_name("hot");
    for (const double y : {1.0, 2.0}) {
        v1::Vector& point = *hot.add_along();
        point.set_x(1.5);
        point.set_y(y);
    }
    hot.mutable_temperature()->set_number(460);
    v1::Probe& probe = add_probe("across", "temperature");
    for (const double x : {0.5, 1.5}) {
        v1::Vector& point = *probe.add_line();
        point.set_x(x);
        point.set_y(1.5);
    }
    probe.set_points(2);
    probe.set_reduce(v1::Probe::DIFFERENCE);
    configure();
    EXPECT_NEAR(value(advance(0.01, 0, 0).sample(), "across"), 60, 1e-9);
}

TEST_F(SolidParticipant, AStretchedBodyTellsStressStrainAndReaction) {
    v1::Body& body = *configure_.mutable_scene()->mutable_solid()->mutable_body(0);
    body.set_motion(v1::Body::DEFORMABLE);
    body.set_start(v1::Body::EQUILIBRIUM);
    const auto side = [&](const char* curve) -> v1::Boundary& {
        v1::Boundary& boundary = *body.add_boundary();
        boundary.set_name(curve);
        boundary.set_curve(curve);
        return boundary;
    };
    side("left").set_fixed_x(true);
    side("bottom").set_fixed_y(true);
    side("right").mutable_traction()->mutable_x()->set_number(1e-4);
    for (const char* quantity : {"stress_xx",
                                 "principal_stress_1",
                                 "principal_stress_2",
                                 "strain_xx",
                                 "strain_yy",
                                 "strain_xy"}) {
        v1::Probe& probe = add_probe(quantity, quantity);
        probe.mutable_at()->set_x(0.93);
        probe.mutable_at()->set_y(1.41);
    }
    add_probe("reaction_x", "reaction_x");
    add_probe("reaction_y", "reaction_y");
    configure();
    const auto& sample = ready_.sample();
    EXPECT_NEAR(value(sample, "stress_xx"), 1e-4, 1e-8); // Cauchy's, of second order in the strain
    EXPECT_NEAR(value(sample, "principal_stress_1"), value(sample, "stress_xx"), 1e-12);
    EXPECT_NEAR(value(sample, "principal_stress_2"), 0, 1e-8);
    EXPECT_NEAR(value(sample, "strain_xx"), 1e-4 * (1 - 0.09) / 5, 1e-8);
    EXPECT_NEAR(value(sample, "strain_yy"), -1e-4 * 0.3 * 1.3 / 5, 1e-8);
    EXPECT_NEAR(value(sample, "strain_xy"), 0, 1e-12);
    EXPECT_NEAR(value(sample, "reaction_x"), -1e-4, 1e-11);
    EXPECT_NEAR(value(sample, "reaction_y"), 0, 1e-11);
}

TEST_F(SolidParticipant, ProbesTakeFieldsAndIntegrals) {
    add_body("beam", 2.5, v1::Body::DEFORMABLE).mutable_initial_temperature()->set_number(500);
    v1::Probe& point = add_probe("point", "temperature");
    point.mutable_at()->set_x(0.77);
    point.mutable_at()->set_y(1.33);
    v1::Probe& line = add_probe("line", "temperature");
    line.add_line()->set_x(0);
    line.mutable_line(0)->set_y(1.5);
    line.add_line()->set_x(4);
    line.mutable_line(1)->set_y(1.5);
    line.set_points(41);
    line.set_reduce(v1::Probe::MAXIMUM);
    v1::Probe& stress = add_probe("stress", "von_mises");
    stress.mutable_at()->set_x(3);
    stress.mutable_at()->set_y(1.5);
    add_probe("mean", "mean_temperature");
    add_probe("beam_mean", "mean_temperature").set_body("beam");
    add_probe("hottest", "max_temperature");
    add_probe("coldest", "min_temperature");
    add_probe("area", "area");
    configure();
    EXPECT_NEAR(value(ready_.sample(), "point"), 400, 1e-12);
    EXPECT_NEAR(value(ready_.sample(), "line"), 500, 1e-12);
    EXPECT_NEAR(value(ready_.sample(), "stress"), 0, 1e-12);
    EXPECT_NEAR(value(ready_.sample(), "mean"), 450, 1e-11);
    EXPECT_NEAR(value(ready_.sample(), "beam_mean"), 500, 1e-11);
    EXPECT_EQ(value(ready_.sample(), "hottest"), 500);
    EXPECT_EQ(value(ready_.sample(), "coldest"), 400);
    EXPECT_NEAR(value(ready_.sample(), "area"), 2, 1e-13);
    const v1::Report report = advance(0.1, 5, 0);
    EXPECT_EQ(report.sample_size(), 8);
    EXPECT_GT(value(report.sample(), "hottest"), 500);
}

TEST_F(SolidParticipant, ProbesThatCannotBeTakenAreRefused) {
    v1::Probe& probe = add_probe("p", "pressure");
    EXPECT_NE(refusal().find("mean_temperature"), std::string::npos); // lists what it knows
    probe.mutable_at()->set_x(1);
    probe.mutable_at()->set_y(1.5);
    EXPECT_NE(refusal().find("displacement_x"), std::string::npos);
    probe.set_quantity("stress_xx");
    EXPECT_NE(refusal().find("fixed one has no stress"), std::string::npos);
    probe.set_quantity("temperature");
    EXPECT_EQ(refusal(), "");
    probe.mutable_at()->set_x(3.5);
    EXPECT_NE(refusal().find("outside"), std::string::npos);
    probe.set_body("plote");
    EXPECT_NE(refusal().find("its bodies are plate"), std::string::npos);
}

TEST_F(SolidParticipant, SavedStateGoesOnInTheSameBits) {
    add_body("beam", 2.5, v1::Body::DEFORMABLE);
    configure();
    advance(0.2, 4, 0.01);
    const std::string middle = solid_.save();
    advance(0.2, -4, 0.02);
    const std::string end = solid_.save();
    solid_.restore(middle);
    EXPECT_TRUE(solid_.save() == middle);
    motion_.time = 0.2;
    advance(0.2, -4, 0.02);
    EXPECT_TRUE(solid_.save() == end);
    EXPECT_THROW(solid_.restore("short"), protocol::Error);
}

TEST_F(SolidParticipant, WithoutAFluidThereIsNoInterface) {
    configure_.mutable_scene()->clear_fluid();
    configure();
    EXPECT_TRUE(chains_.empty());
    EXPECT_EQ(motion_.nodes(), 0u);
    EXPECT_EQ(ready_.stable_step(), 0);
    EXPECT_EQ(advance(1, 0, 0).ledger().heat(), 0);
}

TEST_F(SolidParticipant, FaultsOfTheSceneAndOfTheNumericsAreTold) {
    configure_.mutable_scene()->mutable_solid()->mutable_body(0)->set_motion(v1::Body::DEFORMABLE);
    configure();
    try {
        for (int i = 0; i < 20; ++i) {
            advance(0.5, 0, 1e9);
        }
        FAIL() << "went on";
    } catch (const protocol::Error& error) {
        EXPECT_EQ(error.code(), v1::Failed::DIVERGED);
        EXPECT_NE(std::string(error.what()).find("plate"), std::string::npos);
    }
    add_body("second", 1.2, v1::Body::FIXED);
    EXPECT_NE(refusal().find("overlap"), std::string::npos);
}

} // namespace
} // namespace duet::solid
