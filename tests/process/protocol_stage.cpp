#include "tests/process/protocol_stage.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace duet::test {

namespace {

using Clock = Session::Clock;
using std::chrono::milliseconds;

constexpr std::uint64_t run_id = 4711;
constexpr std::uint32_t lease_size = 4;

} // namespace

Child::Child(const std::vector<std::string>& command) : process_(-1) {
    std::vector<char*> arguments;
    for (const std::string& word : command)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    if (posix_spawn(&process_, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0)
        process_ = -1;
}

Child::~Child() {
    if (process_ == -1)
        return;
    signal(SIGKILL);
    waitpid(process_, nullptr, 0);
}

void Child::signal(int number) const {
    kill(process_, number);
}

int Child::wait(double seconds) {
    const auto deadline = Clock::now() + std::chrono::duration<double>(seconds);
    int status = 0;
    while (waitpid(process_, &status, WNOHANG) == 0) {
        if (Clock::now() > deadline)
            return -1;
        std::this_thread::sleep_for(milliseconds(2));
    }
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::vector<std::string> minimal_cpp(v1::Role role) {
    return {DUET_BINARY_DIR "/bin/duet-minimal-" + protocol::name_of(role)};
}

std::vector<std::string> minimal_python(v1::Role role) {
    return {"/usr/bin/python3",
            DUET_SOURCE_DIR "/protocol/examples/minimal_" + protocol::name_of(role) + ".py"};
}

v1::Scene small_scene() {
    v1::Scene scene;
    scene.mutable_time()->set_end(1);
    v1::Body& body = *scene.mutable_solid()->add_body();
    body.set_name("plate");
    body.mutable_rectangle()->mutable_corner()->set_x(1);
    body.mutable_rectangle()->mutable_corner()->set_y(2);
    body.mutable_rectangle()->set_width(1);
    body.mutable_rectangle()->set_height(0.5);
    body.set_element_size(0.1);
    body.mutable_initial_temperature()->set_number(350);
    body.mutable_initial_velocity()->mutable_x()->set_number(0.25);
    scene.mutable_fluid()->mutable_initial_temperature()->set_number(300);
    return scene;
}

Stage::~Stage() {
    for (const v1::Role role : {v1::ROLE_SOLID, v1::ROLE_FLUID})
        send(role, [](v1::ToSolver& message) { message.mutable_abort()->set_text("Test over."); });
}

void Stage::start(v1::Role role, std::vector<std::string> command) {
    command.insert(command.end(), {"--connect", session.address()});
    children.emplace(role, Child(command));
    greet(role);
}

void Stage::start(protocol::SolidSolver& solid) {
    status[v1::ROLE_SOLID] = std::async(std::launch::async, [this, &solid] {
        return protocol::participate(solid, {session.address(), 5});
    });
    greet(v1::ROLE_SOLID);
}

void Stage::start(protocol::FluidSolver& fluid) {
    status[v1::ROLE_FLUID] = std::async(std::launch::async, [this, &fluid] {
        return protocol::participate(fluid, {session.address(), 5});
    });
    greet(v1::ROLE_FLUID);
}

void Stage::greet(v1::Role role) {
    expect(role, v1::ToOrchestrator::kHello);
}

v1::Configure Stage::configuration(v1::Role role) {
    v1::Configure configure;
    *configure.mutable_version() = protocol::version();
    configure.set_run_id(run_id);
    configure.set_role(role);
    *configure.mutable_scene() = scene;
    configure.set_schedule(schedule);
    if (scene.has_solid() && scene.has_fluid())
        configure.set_peer_address(data_address);
    configure.set_peer_bind(role == v1::ROLE_SOLID);
    configure.set_run_folder(folder.path());
    configure.set_case_folder(folder.path());
    configure.set_threads(1);
    configure.set_heartbeat_interval(0.05);
    configure.set_timeout(timeout);
    configure.set_record(true);
    configure.set_record_address(session.record_address());
    return configure;
}

void Stage::configure(v1::Role role) {
    send(role, [&](v1::ToSolver& message) { *message.mutable_configure() = configuration(role); });
}

void Stage::configure_both() {
    configure(v1::ROLE_SOLID);
    configure(v1::ROLE_FLUID);
    for (int answers = 0; answers < 2; ++answers) {
        const Event event = next();
        ASSERT_TRUE(event.message.has_ready()) << event.text << event.message.ShortDebugString();
    }
}

void Stage::lease(v1::Role role, std::uint64_t first, std::uint32_t count) {
    send(role, [&](v1::ToSolver& message) {
        v1::Lease& lease = *message.mutable_lease();
        lease.set_first(first);
        lease.set_count(count);
        lease.set_time(static_cast<double>(first) * length);
        lease.set_length(length);
        lease.set_sample(true);
    });
}

void Stage::send(v1::Role role, const std::function<void(v1::ToSolver&)>& fill) {
    v1::ToSolver message;
    fill(message);
    session.send(role, message);
}

void Stage::play(std::uint64_t first, std::uint64_t end) {
    for (std::uint64_t window = first; window < end; window += lease_size)
        for (const v1::Role role : {v1::ROLE_SOLID, v1::ROLE_FLUID})
            lease(role,
                  window,
                  static_cast<std::uint32_t>(std::min<std::uint64_t>(lease_size, end - window)));
    for (std::uint64_t left = 2 * (end - first); left > 0; --left) {
        const Event event = next();
        ASSERT_TRUE(event.message.has_report()) << event.text << event.message.ShortDebugString();
        reports[event.role].push_back(event.message.report());
    }
}

void Stage::finish() {
    for (const v1::Role role : {v1::ROLE_SOLID, v1::ROLE_FLUID})
        send(role, [](v1::ToSolver& message) { message.mutable_finish(); });
    for (int answers = 0; answers < 2; ++answers) {
        const Event event = next();
        ASSERT_TRUE(event.message.has_bye()) << event.text << event.message.ShortDebugString();
    }
    for (auto& [role, child] : children)
        EXPECT_EQ(child.wait(5), 0);
    while (const auto event = session.next(Clock::now() + milliseconds(50)))
        if (event->kind == Event::Kind::exchange)
            exchanges.push_back(event->exchange);
}

Event Stage::next() {
    // Long enough for a Python participant to start on a busy machine; how fast a fault is told is
    // measured elsewhere.
    const auto deadline = Clock::now() + std::chrono::seconds(20);
    while (auto event = session.next(deadline)) {
        if (event->kind == Event::Kind::exchange)
            exchanges.push_back(event->exchange);
        else if (!event->message.has_heartbeat())
            return *event;
    }
    ADD_FAILURE() << "nothing came within 20 s";
    return {};
}

v1::ToOrchestrator Stage::expect(v1::Role role, v1::ToOrchestrator::MessageCase kind) {
    const Event event = next();
    EXPECT_EQ(event.kind, Event::Kind::message) << event.text;
    EXPECT_EQ(event.role, role);
    EXPECT_EQ(event.message.message_case(), kind) << event.message.ShortDebugString();
    return event.message;
}

Event Stage::trouble_of(v1::Role role) {
    for (;;) {
        const Event event = next();
        if (event.role == v1::ROLE_UNSPECIFIED && event.text.empty())
            return event; // nothing came: next() has failed the test
        if (event.role == role
            && (event.kind != Event::Kind::message || event.message.has_failed()))
            return event;
    }
}

} // namespace duet::test
