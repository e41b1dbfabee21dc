// The orchestrator's side against solvers and strangers that do what they must not.

#include "protocol/sockets.hpp"
#include "tests/process/protocol_stage.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace duet::test {
namespace {

using Clock = Session::Clock;
using Kind = Event::Kind;
constexpr auto solid = v1::ROLE_SOLID;
constexpr auto fluid = v1::ROLE_FLUID;

/// A solver written by hand: it says what the test wants.
struct Puppet {
    explicit Puppet(const std::string& address)
        : socket(protocol::bounded_socket(context, zmq::socket_type::dealer)) {
        socket.connect(address);
    }

    void say(const std::string& bytes) { (void)socket.send(zmq::buffer(bytes)); }
    void say(const v1::ToOrchestrator& message) { say(message.SerializeAsString()); }

    void hello(v1::Role role, std::uint32_t major = protocol::version().major()) {
        v1::ToOrchestrator message;
        message.mutable_hello()->set_role(role);
        message.mutable_hello()->set_solver("puppet");
        message.mutable_hello()->mutable_version()->set_major(major);
        say(message);
    }

    v1::ToSolver hear() {
        zmq::message_t frame;
        v1::ToSolver message;
        EXPECT_TRUE(socket.recv(frame)) << "nothing came";
        EXPECT_TRUE(message.ParseFromArray(frame.data(), static_cast<int>(frame.size())));
        return message;
    }

    zmq::context_t context;
    zmq::socket_t socket;
};

TEST(Session, RefusesAnotherMajorVersion) {
    Stage stage;
    Puppet puppet(stage.session.address());
    puppet.hello(solid, protocol::version().major() + 1);
    const Event event = stage.next();
    EXPECT_EQ(event.kind, Kind::refused);
    EXPECT_EQ(event.role, solid);
    EXPECT_NE(event.text.find("puppet speaks protocol 3.0, the orchestrator speaks 2.1"),
              std::string::npos)
        << event.text;
    EXPECT_NE(event.text.find("upgrade the orchestrator"), std::string::npos) << event.text;
    EXPECT_EQ(puppet.hear().abort().text(), "The orchestrator ends the run: " + event.text);
    EXPECT_FALSE(stage.session.connected(solid));
}

TEST(Session, RefusesASecondOfARoleAndServesTheFirst) {
    Stage stage;
    Puppet first(stage.session.address());
    first.hello(fluid);
    stage.greet(fluid);
    Puppet second(stage.session.address());
    second.hello(fluid);
    const Event event = stage.next();
    EXPECT_EQ(event.kind, Kind::refused);
    EXPECT_EQ(event.role, v1::ROLE_UNSPECIFIED);
    EXPECT_TRUE(second.hear().has_abort());
    stage.configure(fluid);
    EXPECT_TRUE(first.hear().has_configure());
}

TEST(Session, OutlivesGarbageOfAStranger) {
    Stage stage;
    Puppet stranger(stage.session.address());
    stranger.say(std::string("\xff\xff\xff\xff garbage"));
    EXPECT_EQ(stage.next().kind, Kind::garbage);
    stranger.say(std::string()); // parses, and says nothing
    EXPECT_EQ(stage.next().kind, Kind::garbage);
    v1::ToOrchestrator ready;
    ready.mutable_ready();
    stranger.say(ready);
    const Event event = stage.next();
    EXPECT_EQ(event.kind, Kind::garbage);
    EXPECT_NE(event.text.find("ready without Hello"), std::string::npos) << event.text;

    stage.start(solid, minimal_cpp(solid));
    stage.start(fluid, minimal_cpp(fluid));
    stage.configure_both();
    stage.play(0, 4);
    stage.finish();
}

TEST(Session, OutlivesBytesThatAreNotEvenZeroMQs) {
    Stage stage;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = stage.session.address().substr(std::string("ipc://").size());
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    const int raw = socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(connect(raw, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    const std::string bytes(1000, '\x5a');
    EXPECT_EQ(write(raw, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    // ZeroMQ takes them for messages of its first version; each is told as garbage, no more.
    while (const auto event = stage.session.next(Clock::now() + std::chrono::milliseconds(100))) {
        EXPECT_EQ(event->kind, Kind::garbage);
        EXPECT_EQ(event->role, v1::ROLE_UNSPECIFIED);
    }
    stage.start(solid, minimal_cpp(solid));
    stage.start(fluid, minimal_cpp(fluid));
    stage.configure_both();
    stage.play(0, 4);
    stage.finish();
    close(raw);
}

TEST(Session, NamesTheSolverThatSendsGarbage) {
    Stage stage;
    Puppet puppet(stage.session.address());
    puppet.hello(solid);
    stage.greet(solid);
    puppet.say(std::string("\xff\xff\xff\xff garbage"));
    const Event event = stage.next();
    EXPECT_EQ(event.kind, Kind::garbage);
    EXPECT_EQ(event.role, solid);
    EXPECT_NE(event.text.find("12 bytes"), std::string::npos) << event.text;
}

TEST(Session, RefusesMessagesOutOfTurn) {
    Stage stage;
    Puppet puppet(stage.session.address());
    puppet.hello(solid);
    stage.greet(solid);
    v1::ToOrchestrator saved;
    saved.mutable_saved();
    puppet.say(saved);
    const Event event = stage.next();
    EXPECT_EQ(event.kind, Kind::refused);
    EXPECT_EQ(event.role, solid);
    EXPECT_NE(event.text.find("saved out of turn"), std::string::npos) << event.text;
    EXPECT_TRUE(puppet.hear().has_abort());
}

TEST(Session, RefusesReportsOfWindowsNotDue) {
    Stage stage;
    Puppet puppet(stage.session.address());
    puppet.hello(solid);
    stage.greet(solid);
    v1::ToOrchestrator message;
    message.mutable_ready();
    puppet.say(message);
    stage.expect(solid, v1::ToOrchestrator::kReady);
    stage.lease(solid, 0, 2);
    message.mutable_report()->set_window(0);
    puppet.say(message);
    stage.expect(solid, v1::ToOrchestrator::kReport);
    puppet.say(message); // window 0 again
    const Event event = stage.next();
    EXPECT_EQ(event.kind, Kind::refused);
    EXPECT_NE(event.text.find("reported window 0 where 1 was due"), std::string::npos)
        << event.text;
}

TEST(Session, TellsAllThatWasSaidAndThenTheLoss) {
    Stage stage;
    {
        Puppet puppet(stage.session.address());
        puppet.hello(fluid);
        v1::ToOrchestrator message;
        message.mutable_ready();
        puppet.say(message);
        puppet.socket.close(); // flushes both
    }
    stage.greet(fluid);
    stage.expect(fluid, v1::ToOrchestrator::kReady);
    const auto before = Clock::now();
    const Event event = stage.next();
    EXPECT_EQ(event.kind, Kind::disconnected);
    EXPECT_EQ(event.role, fluid);
    // The news of a closed socket takes milliseconds; a second allows for a busy machine.
    EXPECT_LT(Clock::now() - before, std::chrono::seconds(1));
    EXPECT_FALSE(stage.session.connected(fluid));
    EXPECT_FALSE(stage.session.send(fluid, {}));
}

TEST(Session, SeesAKilledProcess) {
    Stage stage;
    stage.start(solid, minimal_cpp(solid));
    stage.children.at(solid).signal(SIGKILL);
    const auto before = Clock::now();
    const Event event = stage.next();
    EXPECT_EQ(event.kind, Kind::disconnected);
    EXPECT_EQ(event.role, solid);
    EXPECT_LT(Clock::now() - before, std::chrono::seconds(1));
}

TEST(Session, WakesForAWatchedDescriptorAndAtItsDeadline) {
    Stage stage;
    const int descriptor = eventfd(0, EFD_NONBLOCK);
    stage.session.watch(descriptor);
    const auto before = Clock::now();
    EXPECT_FALSE(stage.session.next(before + std::chrono::milliseconds(50)));
    EXPECT_GE(Clock::now() - before, std::chrono::milliseconds(50));
    eventfd_write(descriptor, 1);
    const auto event = stage.session.next(Clock::now() + std::chrono::seconds(5));
    ASSERT_TRUE(event);
    EXPECT_EQ(event->kind, Kind::descriptor);
    EXPECT_EQ(event->descriptor, descriptor);
    stage.session.unwatch(descriptor);
    EXPECT_FALSE(stage.session.next(Clock::now() - std::chrono::seconds(1)));
    close(descriptor);
}

TEST(Session, ForgetsADescriptorThatWasClosed) {
    Stage stage;
    const int descriptor = eventfd(1, EFD_NONBLOCK);
    stage.session.watch(descriptor);
    close(descriptor);
    EXPECT_FALSE(stage.session.next(Clock::now() + std::chrono::milliseconds(50)));
}

TEST(Session, HasNobodyToSendToBeforeHello) {
    Stage stage;
    EXPECT_FALSE(stage.session.connected(solid));
    EXPECT_FALSE(stage.session.send(solid, {}));
    EXPECT_EQ(stage.session.last_heard(solid), Clock::time_point{});
}

TEST(Session, CannotListenWhereThereIsNoFolder) {
    try {
        const Session session("ipc:///nowhere/at/all");
        FAIL() << "no error";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("/nowhere/at/all"), std::string::npos);
    }
}

TEST(SocketFolder, IsPrivateAndGoesAway) {
    std::filesystem::path path;
    {
        const protocol::SocketFolder folder;
        path = folder.path();
        using std::filesystem::perms;
        EXPECT_EQ(std::filesystem::status(path).permissions(), perms::owner_all);
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

} // namespace
} // namespace duet::test
