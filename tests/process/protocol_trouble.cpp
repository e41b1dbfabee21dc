// Participants whose peer, orchestrator or own solver does what it must not: each ends soon, exits
// non-zero and says why.

#include "protocol/interface_codec.hpp"
#include "protocol/sockets.hpp"
#include "tests/process/protocol_stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <fstream>

namespace duet::test {
namespace {

using Clock = Session::Clock;
using Kind = Event::Kind;
using protocol::Chain;
using protocol::InterfaceLoad;
using protocol::InterfaceMotion;
using protocol::Window;
constexpr auto solid = v1::ROLE_SOLID;
constexpr auto fluid = v1::ROLE_FLUID;
const auto one_second = std::chrono::seconds(1);

void expect_words(const std::string& sentence, const std::vector<std::string>& words) {
    for (const std::string& word : words)
        EXPECT_NE(sentence.find(word), std::string::npos) << word << " is not in: " << sentence;
}

using Command = std::vector<std::string> (*)(v1::Role);

/// C++ and Python participants must behave alike.
class Participant : public testing::TestWithParam<Command> {
  protected:
    /// Both run, and are left in the middle of a long lease: solid tested, fluid its peer.
    void play_into_a_lease(Stage& stage) const {
        stage.start(solid, GetParam()(solid));
        stage.start(fluid, minimal_cpp(fluid));
        stage.configure_both();
        stage.play(0, 4);
        stage.lease(solid, 4, 1000); // the fluid has none: the solid waits for its load
    }
};

TEST_P(Participant, SeesAPeerThatDied) {
    Stage stage;
    play_into_a_lease(stage);
    stage.children.at(fluid).signal(SIGKILL);
    const auto before = Clock::now();
    const Event event = stage.trouble_of(solid);
    EXPECT_LT(Clock::now() - before, one_second);
    EXPECT_EQ(event.message.failed().code(), v1::Failed::PEER);
    EXPECT_EQ(event.message.failed().window(), 4U);
    expect_words(event.message.failed().text(), {"fluid", "closed its connection"});
    EXPECT_EQ(stage.children.at(solid).wait(5), 1);
}

TEST_P(Participant, DoesNotWaitForASilentPeerForEver) {
    Stage stage;
    stage.timeout = 0.5;
    play_into_a_lease(stage);
    stage.children.at(fluid).signal(SIGSTOP);
    const auto before = Clock::now();
    const Event event = stage.trouble_of(solid);
    EXPECT_LT(Clock::now() - before, 2 * one_second);
    EXPECT_EQ(event.message.failed().code(), v1::Failed::PEER);
    expect_words(event.message.failed().text(), {"fluid", "silent for 0.5"});
    EXPECT_EQ(stage.children.at(solid).wait(5), 1);
}

TEST_P(Participant, ObeysAbortWhileItWaitsForItsPeer) {
    Stage stage;
    play_into_a_lease(stage);
    const auto before = Clock::now();
    stage.send(solid, [](v1::ToSolver& m) { m.mutable_abort()->set_text("Enough."); });
    EXPECT_EQ(stage.children.at(solid).wait(5), 1);
    EXPECT_LT(Clock::now() - before, one_second);
}

TEST_P(Participant, EndsWithItsOrchestrator) {
    auto stage = std::make_unique<Stage>();
    play_into_a_lease(*stage);
    Child child = std::move(stage->children.at(solid));
    stage->session.~Session(); // gone without a word
    new (&stage->session) Session(stage->folder.address("another"));
    const auto before = Clock::now();
    EXPECT_EQ(child.wait(5), 1);
    // If it hears of the fluid's end first, what it says of that waits for nobody.
    EXPECT_LT(Clock::now() - before, one_second);
}

TEST_P(Participant, RefusesAnOrchestratorOfAnotherVersion) {
    Stage stage;
    stage.start(solid, GetParam()(solid));
    stage.send(solid, [&](v1::ToSolver& m) {
        *m.mutable_configure() = stage.configuration(solid);
        m.mutable_configure()->mutable_version()->set_major(7);
    });
    const v1::ToOrchestrator answer = stage.expect(solid, v1::ToOrchestrator::kFailed);
    EXPECT_EQ(answer.failed().code(), v1::Failed::VERSION);
    expect_words(answer.failed().text(),
                 {"speaks protocol 7.1", "speaks 2.1", "upgrade ", "minimal"});
    EXPECT_EQ(stage.children.at(solid).wait(5), 1);
}

TEST_P(Participant, RefusesASceneThatItCannotModel) {
    Stage stage;
    v1::Probe& probe = *stage.scene.add_probe();
    probe.set_name("p");
    probe.set_of(v1::Probe::SOLID);
    probe.set_quantity("beauty");
    stage.start(solid, GetParam()(solid));
    stage.configure(solid);
    const v1::ToOrchestrator answer = stage.expect(solid, v1::ToOrchestrator::kFailed);
    EXPECT_EQ(answer.failed().code(), v1::Failed::SCENE);
    expect_words(answer.failed().text(), {"'p'", "'beauty'", "temperature"});
}

TEST_P(Participant, RefusesALeaseOutOfTurn) {
    Stage stage;
    stage.scene.clear_fluid();
    stage.start(solid, GetParam()(solid));
    stage.configure(solid);
    stage.expect(solid, v1::ToOrchestrator::kReady);
    stage.lease(solid, 3, 1);
    const v1::ToOrchestrator answer = stage.expect(solid, v1::ToOrchestrator::kFailed);
    EXPECT_EQ(answer.failed().code(), v1::Failed::PEER);
    expect_words(answer.failed().text(), {"leased window 3 where window 0 is due"});
}

TEST_P(Participant, PlaysAlone) {
    Stage stage;
    stage.scene.clear_fluid();
    stage.start(solid, GetParam()(solid));
    stage.configure(solid);
    stage.expect(solid, v1::ToOrchestrator::kReady);
    stage.lease(solid, 0, 3);
    for (std::uint64_t k = 0; k < 3; ++k)
        EXPECT_EQ(stage.expect(solid, v1::ToOrchestrator::kReport).report().window(), k);
    stage.send(solid, [](v1::ToSolver& m) { m.mutable_finish(); });
    stage.expect(solid, v1::ToOrchestrator::kBye);
    EXPECT_EQ(stage.children.at(solid).wait(5), 0);
}

/// The test in the place of the fluid: what it sends as the load of window 0 must be refused.
void expect_load_refused(Command command,
                         const std::function<void(v1::ToPeer&)>& spoil,
                         const std::vector<std::string>& words) {
    Stage stage;
    zmq::context_t context;
    zmq::socket_t pair = protocol::bounded_socket(context, zmq::socket_type::pair);
    pair.connect(stage.folder.address("data"));
    stage.start(solid, command(solid));
    stage.configure(solid);
    stage.expect(solid, v1::ToOrchestrator::kReady);
    stage.lease(solid, 0, 1);
    v1::ToPeer message;
    protocol::encode({stage.configuration(solid).run_id(), false, {0, 0, stage.length}},
                     {30, 30},
                     InterfaceLoad{0, 0, std::vector<double>(60, 1), std::vector<double>(30, 1)},
                     message);
    spoil(message);
    (void)pair.send(zmq::buffer(message.SerializeAsString()));
    const v1::ToOrchestrator answer = stage.expect(solid, v1::ToOrchestrator::kFailed);
    EXPECT_EQ(answer.failed().code(), v1::Failed::PEER);
    expect_words(answer.failed().text(), words);
    EXPECT_EQ(stage.children.at(solid).wait(5), 1);
}

TEST_P(Participant, RefusesALoadThatIsNotANumber) {
    const double nan = std::nan("");
    expect_load_refused(
        GetParam(),
        [&](v1::ToPeer& m) {
            m.mutable_load()->mutable_force()->replace(
                5 * sizeof nan, sizeof nan, reinterpret_cast<const char*>(&nan), sizeof nan);
        },
        {"fluid", "window 0", "force[2].y", "nan"});
}

TEST_P(Participant, RefusesALoadOfNegativeImpedance) {
    const auto negative = [](v1::ToPeer& m) { m.mutable_load()->set_impedance(-1.5); };
    expect_load_refused(GetParam(), negative, {"fluid", "window 0", "impedance is -1.5"});
}

TEST_P(Participant, RefusesALoadOfTheWrongLength) {
    const auto shorten = [](v1::ToPeer& m) { m.mutable_load()->mutable_heat_flow()->resize(100); };
    expect_load_refused(GetParam(), shorten, {"fluid", "heat_flow", "100 bytes", "240"});
}

TEST_P(Participant, RefusesALoadOutOfTurn) {
    const auto later = [](v1::ToPeer& m) { m.mutable_load()->set_window(1); };
    expect_load_refused(GetParam(), later, {"fluid", "out of turn", "window 1"});
    const auto other_run = [](v1::ToPeer& m) { m.mutable_load()->set_run_id(1); };
    expect_load_refused(GetParam(), other_run, {"fluid", "run 1,"});
    const auto other_time = [](v1::ToPeer& m) { m.mutable_load()->set_length(9); };
    expect_load_refused(GetParam(), other_time, {"fluid", "it covers 9"});
    const auto other_kind = [](v1::ToPeer& m) { m.mutable_motion(); };
    expect_load_refused(GetParam(), other_kind, {"fluid", "another kind"});
}

TEST_P(Participant, RefusesGarbageOnTheDataPlane) {
    Stage stage;
    zmq::context_t context;
    zmq::socket_t pair = protocol::bounded_socket(context, zmq::socket_type::pair);
    pair.connect(stage.folder.address("data"));
    stage.start(solid, GetParam()(solid));
    stage.configure(solid);
    stage.expect(solid, v1::ToOrchestrator::kReady);
    stage.lease(solid, 0, 1);
    (void)pair.send(zmq::str_buffer("\xff\xff\xff\xff garbage"));
    const v1::ToOrchestrator answer = stage.expect(solid, v1::ToOrchestrator::kFailed);
    EXPECT_EQ(answer.failed().code(), v1::Failed::PEER);
    expect_words(answer.failed().text(), {"fluid", "12 bytes", "no message"});
}

// Four windows, saved, four more; and from the file alone, in new processes, the last four again.
TEST_P(Participant, GoesOnFromACheckpointAsIfNothingHadBeen) {
    Stage stage;
    stage.schedule = v1::Coupling::SOLID_FIRST; // the load in flight must come back, too
    stage.start(solid, GetParam()(solid));
    stage.start(fluid, GetParam()(fluid));
    stage.configure_both();
    stage.play(0, 4);
    Stage again;
    again.schedule = stage.schedule;
    for (const v1::Role role : {solid, fluid}) {
        const std::string path = again.folder.path() / protocol::name_of(role);
        stage.send(role, [&](v1::ToSolver& m) {
            m.mutable_save()->set_window(3);
            m.mutable_save()->set_path(path);
        });
        EXPECT_EQ(stage.expect(role, v1::ToOrchestrator::kSaved).saved().window(), 3U);
    }
    stage.play(4, 8);
    stage.finish();

    again.start(solid, GetParam()(solid));
    again.start(fluid, GetParam()(fluid));
    again.configure_both();
    for (const v1::Role role : {solid, fluid}) {
        again.send(role, [&](v1::ToSolver& m) {
            m.mutable_restore()->set_window(3);
            m.mutable_restore()->set_path(protocol::name_of(role)); // under the run's folder
        });
        const v1::ToOrchestrator answer = again.expect(role, v1::ToOrchestrator::kRestored);
        EXPECT_EQ(answer.restored().window(), 3U);
        EXPECT_DOUBLE_EQ(answer.restored().time(), 4 * stage.length);
    }
    again.play(4, 8);
    again.finish();
    for (const v1::Role role : {solid, fluid})
        EXPECT_EQ(again.reports[role].back().ledger().SerializeAsString(),
                  stage.reports[role].back().ledger().SerializeAsString());
    // The motion and the load of window 7, in the same bits. (The two come in any order.)
    const auto last_bytes = [](const Stage& of) {
        std::string motion, load;
        for (const v1::ToPeer& exchange : of.exchanges) {
            if (exchange.motion().window() == 7)
                motion = exchange.motion().position();
            if (exchange.load().window() == 7)
                load = exchange.load().force();
        }
        return motion + load;
    };
    EXPECT_EQ(last_bytes(stage).size(), 30 * 2 * 2 * sizeof(double));
    EXPECT_TRUE(last_bytes(again) == last_bytes(stage));
}

TEST_P(Participant, RefusesACheckpointThatIsNone) {
    Stage stage;
    stage.scene.clear_fluid();
    stage.start(solid, GetParam()(solid));
    stage.configure(solid);
    stage.expect(solid, v1::ToOrchestrator::kReady);
    std::ofstream(stage.folder.path() / "broken") << "\xff\xff\xff\xff";
    stage.send(solid, [](v1::ToSolver& m) { m.mutable_restore()->set_path("broken"); });
    const v1::ToOrchestrator answer = stage.expect(solid, v1::ToOrchestrator::kFailed);
    EXPECT_EQ(answer.failed().code(), v1::Failed::INTERNAL);
    expect_words(answer.failed().text(), {"broken", "no checkpoint"});
}

TEST_P(Participant, ExplainsItsCommandLine) {
    auto bare = GetParam()(solid);
    EXPECT_EQ(Child(bare).wait(5), 2);
    bare.push_back("--help");
    EXPECT_EQ(Child(bare).wait(5), 0);
}

INSTANTIATE_TEST_SUITE_P(Languages,
                         Participant,
                         testing::Values(minimal_cpp, minimal_python),
                         [](const auto& parameter) {
                             return parameter.param == minimal_cpp ? "cpp" : "python";
                         });

/// In this process: a fluid that gives back what the test wants.
class TestFluid final : public protocol::FluidSolver {
  public:
    std::function<void(InterfaceLoad&, v1::Report&)> spoil = [](auto&, auto&) {};
    std::string name() const override { return "test fluid"; }
    void configure(const v1::Configure&,
                   const std::vector<Chain>&,
                   const InterfaceMotion&,
                   v1::Ready&) override {}
    void advance(const Window&,
                 const InterfaceMotion& start,
                 const InterfaceMotion&,
                 InterfaceLoad& load,
                 v1::Report& report) override {
        load.force.assign(2 * start.nodes(), 0);
        load.heat_flow.assign(start.nodes(), 0);
        spoil(load, report);
    }
    std::string save() const override { return ""; }
    void restore(const std::string&) override {}
    void finish() override {}
};

/// The fluid's own fault: it is told to the orchestrator and to the solid, which ends for it.
void expect_fluid_fails(const std::function<void(InterfaceLoad&, v1::Report&)>& spoil,
                        v1::Failed::Code code,
                        const std::vector<std::string>& words) {
    TestFluid test_fluid;
    test_fluid.spoil = spoil;
    Stage stage;
    stage.start(test_fluid);
    stage.start(solid, minimal_cpp(solid));
    stage.configure_both();
    stage.lease(solid, 0, 1);
    stage.lease(fluid, 0, 1);
    std::map<v1::Role, v1::Failed> failed;
    for (int i = 0; i < 2; ++i) {
        const Event event = stage.next();
        failed[event.role] = event.message.failed();
    }
    EXPECT_EQ(failed[fluid].code(), code);
    expect_words(failed[fluid].text(), words);
    EXPECT_EQ(failed[solid].code(), v1::Failed::PEER);
    expect_words(failed[solid].text(), {"The fluid failed: " + failed[fluid].text()});
    EXPECT_EQ(stage.status[fluid].get(), 1);
    EXPECT_EQ(stage.children.at(solid).wait(5), 1);
}

TEST(OwnSolver, NumbersThatAreNoneDoNotLeaveIt) {
    expect_fluid_fails([](auto& load, auto&) { load.heat_flow[4] = std::nan(""); },
                       v1::Failed::DIVERGED,
                       {"heat_flow[4]", "window 0"});
    expect_fluid_fails([](auto&, auto& report) { report.mutable_ledger()->set_mass(INFINITY); },
                       v1::Failed::DIVERGED,
                       {"mass", "window 0"});
}

TEST(OwnSolver, ItsErrorsAreTold) {
    expect_fluid_fails(
        [](auto&, auto&) { throw protocol::Error(v1::Failed::DIVERGED, "The fluid boils over."); },
        v1::Failed::DIVERGED,
        {"The fluid boils over."});
    expect_fluid_fails([](auto&, auto&) { throw std::out_of_range("no such particle"); },
                       v1::Failed::INTERNAL,
                       {"no such particle"});
}

/// A solid whose window takes a minute, in the midst of it.
struct SlowStage : Stage {
    SlowStage() {
        scene.clear_fluid();
        start(solid, {DUET_BINARY_DIR "/bin/test_slow_solid"});
        configure(solid);
        expect(solid, v1::ToOrchestrator::kReady);
        lease(solid, 0, 1);
        wait_for_beat();
    }

    /// A heartbeat from within the window.
    void wait_for_beat() {
        const auto deadline = Clock::now() + std::chrono::seconds(5);
        while (const auto event = session.next(deadline))
            if (event->message.heartbeat().phase() == "advancing")
                return;
        ADD_FAILURE() << "no heartbeat within 5 s";
    }
};

TEST(BusySolver, BeatsWhileItComputes) {
    SlowStage stage;
    const auto before = Clock::now();
    for (int beats = 0; beats < 5; ++beats)
        stage.wait_for_beat();
    EXPECT_LT(Clock::now() - before, one_second) << "one is due every 0.05 s";
    EXPECT_LT(Clock::now() - stage.session.last_heard(solid), one_second);
}

TEST(BusySolver, IsEndedWhenTheRunIsOver) {
    SlowStage stage;
    stage.send(solid, [](v1::ToSolver& m) { m.mutable_abort()->set_text("Enough."); });
    // The grace of control_link.cpp is 2 s; a minute would be the window.
    EXPECT_EQ(stage.children.at(solid).wait(4), 1);
}

TEST(Connecting, GivesUpWhereNobodyListens) {
    const protocol::SocketFolder folder;
    TestFluid test_fluid;
    const auto before = Clock::now();
    EXPECT_EQ(protocol::participate(test_fluid, {folder.address("control"), 0.2}), 1);
    EXPECT_LT(Clock::now() - before, 3 * one_second);
    EXPECT_EQ(protocol::participate(test_fluid, {"nonsense", 0.2}), 1);
}

} // namespace
} // namespace duet::test
