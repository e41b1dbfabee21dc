// A small orchestrator for the tests of the protocol: it starts participants as processes or
// threads, leads them, and keeps what they report.

#pragma once

#include "protocol/participant.hpp"
#include "protocol/session.hpp"
#include "protocol/socket_folder.hpp"

#include <functional>
#include <future>
#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

namespace duet::test {

using protocol::Event;
using protocol::Session;

/// A process of this test; killed with the object.
class Child {
  public:
    explicit Child(const std::vector<std::string>& command);
    ~Child();
    Child(Child&& other) noexcept : process_(other.process_) { other.process_ = -1; }
    Child& operator=(Child&&) = delete;

    void signal(int number) const;

    /// The exit status (128 + signal if killed); -1 if it still runs after so many seconds.
    int wait(double seconds);

  private:
    pid_t process_;
};

/// The command lines of the examples.
std::vector<std::string> minimal_cpp(v1::Role role);
std::vector<std::string> minimal_python(v1::Role role);

/// One body of 1 m x 0.5 m with 30 interface nodes, and a fluid round it.
v1::Scene small_scene();

struct Stage {
    Stage() : session(folder.address("control"), folder.address("record")) {}

    /// Over TCP; `data` is the address of the data plane.
    explicit Stage(const std::string& data)
        : session("tcp://127.0.0.1:*", "tcp://127.0.0.1:*"), data_address(data) {}
    ~Stage();

    /// Starts a participant and takes its Hello.
    void start(v1::Role role, std::vector<std::string> command);
    void start(protocol::SolidSolver& solid);
    void start(protocol::FluidSolver& fluid);
    void greet(v1::Role role);

    v1::Configure configuration(v1::Role role);
    void configure(v1::Role role);

    /// Both solvers, up to Ready; `schedule` and `timeout` as they stand.
    void configure_both();

    void lease(v1::Role role, std::uint64_t first, std::uint32_t count);
    void send(v1::Role role, const std::function<void(v1::ToSolver&)>& fill);

    /// Leads both from `first` to `end` - 1 in leases of four, granted ahead; keeps the reports.
    void play(std::uint64_t first, std::uint64_t end);
    /// Finish and Bye; then the processes must exit with 0, and the last exchanges are taken.
    void finish();

    /// The next event that is neither a heartbeat nor an exchange (those are kept), within 5 s;
    /// fails the test and gives an empty one if there is none.
    Event next();

    /// The next event must be a message of this kind from this role.
    v1::ToOrchestrator expect(v1::Role role, v1::ToOrchestrator::MessageCase kind);

    /// Takes events until `role` sends Failed or is refused or lost.
    Event trouble_of(v1::Role role);

    protocol::SocketFolder folder;
    Session session;
    std::string data_address = folder.address("data");
    v1::Scene scene = small_scene();
    v1::Coupling::Schedule schedule = v1::Coupling::FLUID_FIRST;
    double timeout = 5;
    double length = 0.01; // of a window
    std::map<v1::Role, Child> children;
    std::map<v1::Role, std::future<int>> status; // of the participants in threads
    std::map<v1::Role, std::vector<v1::Report>> reports;
    std::vector<v1::ToPeer> exchanges;
};

} // namespace duet::test
