// Whole runs of participants as processes, led by the test.

#include "tests/process/protocol_stage.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <zmq.hpp>

namespace duet::test {
namespace {

constexpr auto solid = v1::ROLE_SOLID;
constexpr auto fluid = v1::ROLE_FLUID;

std::vector<double> numbers(const std::string& bytes) {
    std::vector<double> values(bytes.size() / sizeof(double));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
    return values;
}

struct Cast {
    const char* name;
    std::vector<std::string> (*solid_command)(v1::Role);
    std::vector<std::string> (*fluid_command)(v1::Role);
    v1::Coupling::Schedule schedule;
};

void PrintTo(const Cast& cast, std::ostream* stream) {
    *stream << cast.name;
}

class Run : public testing::TestWithParam<Cast> {};

// What the examples prescribe arrives: the loads of the fluid on the solid's books, the motion of
// the solid in the record, and all of it balanced.
TEST_P(Run, PlaysToItsEnd) {
    constexpr int windows = 10;
    Stage stage;
    stage.schedule = GetParam().schedule;
    stage.start(solid, GetParam().solid_command(solid));
    stage.start(fluid, GetParam().fluid_command(fluid));
    stage.configure_both();
    stage.play(0, windows);
    stage.finish();

    ASSERT_EQ(stage.reports[solid].size(), windows);
    ASSERT_EQ(stage.reports[fluid].size(), windows);
    for (int k = 0; k < windows; ++k)
        for (const v1::Role role : {solid, fluid}) {
            EXPECT_EQ(stage.reports[role][k].window(), k);
            EXPECT_DOUBLE_EQ(stage.reports[role][k].time(), (k + 1) * stage.length);
        }

    // 100 W/m2 and (0.3, -0.2) Pa on 3 m of outline. With fluid_first the load of window k acts in
    // window k, else one window later; what the fluid sent last is then still under way.
    const bool at_once = GetParam().schedule == v1::Coupling::FLUID_FIRST;
    const double sent = windows * stage.length;
    const double acted = at_once ? sent : sent - stage.length;
    const v1::Ledger& of_solid = stage.reports[solid].back().ledger();
    const v1::Ledger& of_fluid = stage.reports[fluid].back().ledger();
    EXPECT_NEAR(of_fluid.heat_from_interface(), -300 * sent, 1e-12);
    EXPECT_NEAR(of_solid.heat_from_interface(), 300 * acted, 1e-12);
    EXPECT_NEAR(of_solid.impulse_x(), 0.9 * acted, 1e-12);
    EXPECT_NEAR(of_solid.impulse_y(), -0.6 * acted, 1e-12);
    EXPECT_NEAR(of_solid.work(), 0.9 * 0.25 * acted, 1e-12);

    // The record: the start, then one motion and one load a window.
    int motions = 0, loads = 0;
    for (const v1::ToPeer& exchange : stage.exchanges) {
        if (exchange.has_load()) {
            EXPECT_EQ(exchange.load().window(), loads++);
            EXPECT_NEAR(exchange.load().heat(), 300 * stage.length, 1e-12);
            continue;
        }
        const v1::InterfaceMotion& motion = exchange.motion();
        EXPECT_EQ(motion.start(), motions == 0);
        EXPECT_EQ(motion.chain_size(), motions == 0 ? 1 : 0);
        const std::vector<double> position = numbers(motion.position());
        ASSERT_EQ(position.size(), 60);
        // All three schedules move the solid by its velocity; node 0 starts at the corner (1, 2).
        EXPECT_NEAR(position[0], 1 + 0.25 * stage.length * motions, 1e-12);
        EXPECT_NEAR(position[1], 2, 1e-12);
        EXPECT_EQ(numbers(motion.temperature()), std::vector<double>(30, 350));
        ++motions;
    }
    EXPECT_EQ(motions, windows + 1);
    EXPECT_EQ(loads, windows);
}

constexpr auto fluid_first = v1::Coupling::FLUID_FIRST;
constexpr auto solid_first = v1::Coupling::SOLID_FIRST;
constexpr auto parallel = v1::Coupling::PARALLEL;

INSTANTIATE_TEST_SUITE_P(
    Casts,
    Run,
    testing::Values(Cast{"cpp_cpp_fluid_first", minimal_cpp, minimal_cpp, fluid_first},
                    Cast{"cpp_cpp_solid_first", minimal_cpp, minimal_cpp, solid_first},
                    Cast{"cpp_cpp_parallel", minimal_cpp, minimal_cpp, parallel},
                    Cast{"python_cpp_fluid_first", minimal_python, minimal_cpp, fluid_first},
                    Cast{"cpp_python_fluid_first", minimal_cpp, minimal_python, fluid_first},
                    Cast{"cpp_python_solid_first", minimal_cpp, minimal_python, solid_first},
                    Cast{"python_cpp_parallel", minimal_python, minimal_cpp, parallel},
                    Cast{"python_python_solid_first", minimal_python, minimal_python, solid_first}),
    [](const auto& parameter) { return parameter.param.name; });

TEST(Tcp, CarriesARunAndTheNewsOfADeath) {
    zmq::context_t context;
    zmq::socket_t free_port(context, zmq::socket_type::pair);
    free_port.bind("tcp://127.0.0.1:*");
    const std::string data = free_port.get(zmq::sockopt::last_endpoint);
    free_port.close();
    Stage stage(data);
    stage.start(solid, minimal_cpp(solid));
    stage.start(fluid, minimal_cpp(fluid));
    stage.configure_both();
    stage.play(0, 8);
    stage.lease(solid, 8, 4);
    stage.children.at(fluid).signal(SIGKILL);
    const Event event = stage.trouble_of(solid);
    EXPECT_EQ(event.message.failed().code(), v1::Failed::PEER) << event.text;
}

/// A solid whose first node jumps to x = (windows done)^2, although its velocity is (windows done);
/// its temperature is 7 more than that.
class JumpingSolid final : public protocol::SolidSolver {
  public:
    std::string name() const override { return "jumping solid"; }
    void configure(const v1::Configure&,
                   v1::Ready&,
                   std::vector<protocol::Chain>& chains,
                   protocol::InterfaceMotion& start) override {
        chains = {{{0, 1, 2}, true}};
        place(0, start);
    }
    void advance(const protocol::Window& window,
                 const protocol::InterfaceLoad&,
                 protocol::InterfaceMotion& end,
                 v1::Report&) override {
        place(static_cast<double>(window.index) + 1, end);
    }
    std::string save() const override { return ""; }
    void restore(const std::string&) override {}
    void finish() override {}

  private:
    static void place(double windows_done, protocol::InterfaceMotion& motion) {
        motion.position.assign(6, 0);
        motion.position[0] = windows_done * windows_done;
        motion.velocity.assign(6, windows_done);
        motion.temperature = {7 + windows_done, 8, 9};
    }
};

/// Keeps what it is told of the first node.
class WatchingFluid final : public protocol::FluidSolver {
  public:
    std::vector<std::array<double, 2>> start_x_and_end_x;
    std::vector<double> end_time, end_velocity, end_temperature;
    std::string name() const override { return "watching fluid"; }
    void configure(const v1::Configure&,
                   const std::vector<protocol::Chain>&,
                   const protocol::InterfaceMotion&,
                   v1::Ready&) override {}
    void advance(const protocol::Window&,
                 const protocol::InterfaceMotion& start,
                 const protocol::InterfaceMotion& end,
                 protocol::InterfaceLoad& load,
                 v1::Report&) override {
        start_x_and_end_x.push_back({start.position[0], end.position[0]});
        end_time.push_back(end.time);
        end_velocity.push_back(end.velocity[0]);
        end_temperature.push_back(end.temperature[0]);
        load.force.assign(6, 0);
        load.heat_flow.assign(3, 0);
    }
    std::string save() const override { return ""; }
    void restore(const std::string&) override {}
    void finish() override {}
};

TEST(FluidSide, KnowsOrPredictsTheEndOfTheWindow) {
    for (const auto schedule : {fluid_first, solid_first, parallel}) {
        JumpingSolid jumping;
        WatchingFluid watching;
        Stage stage;
        stage.schedule = schedule;
        stage.start(jumping);
        stage.start(watching);
        stage.configure_both();
        stage.play(0, 4);
        stage.finish();
        ASSERT_EQ(watching.start_x_and_end_x.size(), 4);
        for (std::size_t k = 0; k < 4; ++k) {
            const double before = std::pow(static_cast<double>(k), 2);
            const double after = std::pow(static_cast<double>(k) + 1, 2);
            const auto& [start_x, end_x] = watching.start_x_and_end_x[k];
            EXPECT_EQ(start_x, before);
            // Predicted: from the second window on the velocity grows by 1 in every window.
            const double n = static_cast<double>(k), grown = k > 0 ? 1 : 0;
            const double predicted = before + stage.length * (n + 0.5 * grown);
            const bool known = schedule == solid_first;
            EXPECT_DOUBLE_EQ(end_x, known ? after : predicted);
            EXPECT_DOUBLE_EQ(watching.end_velocity[k], known ? n + 1 : n + grown);
            EXPECT_DOUBLE_EQ(watching.end_temperature[k], known ? n + 8 : n + 7 + grown);
            EXPECT_DOUBLE_EQ(watching.end_time[k], static_cast<double>(k + 1) * stage.length);
        }
    }
}

/// The participant that the specification works out is run as it stands there.
TEST(Readme, ItsParticipantTakesPartInARun) {
    std::ifstream readme(DUET_SOURCE_DIR "/protocol/README.md");
    const std::string text{std::istreambuf_iterator<char>(readme), {}};
    const std::string fence = "```python\n";
    const auto begin = text.find(fence) + fence.size();
    const auto end = text.find("```", begin);
    ASSERT_NE(end, std::string::npos);

    Stage stage;
    const std::string program = stage.folder.path() / "cooling.py";
    std::ofstream(program) << text.substr(begin, end - begin);
    stage.start(solid, minimal_cpp(solid));
    stage.start(fluid,
                {"/usr/bin/env",
                 "PYTHONPATH=" DUET_SOURCE_DIR "/protocol/python",
                 "/usr/bin/python3",
                 program});
    stage.configure_both();
    stage.play(0, 5);
    stage.finish();
    // h (T_fluid - T) = 20 * (300 - 350) on 3 m of outline for 5 windows.
    const double heat = -3000 * 5 * stage.length;
    EXPECT_NEAR(stage.reports[solid].back().ledger().heat_from_interface(), heat, 1e-9);
    EXPECT_NEAR(stage.reports[fluid].back().ledger().heat_from_interface(), -heat, 1e-9);
}

} // namespace
} // namespace duet::test
