// What the protocol costs: one coupling window of an interface of 320 nodes, both ways between two
// processes, through the participant library (encode, check, send, receive, decode, check the turn,
// report), beside a bare round trip of equal bytes over a PAIR socket of the same kind between the
// same two processes.
//
//     bench_exchange [--windows N]
//
// The parent is the orchestrator and the fluid, its child the solid. Neither solver computes
// anything, so a window is the exchange and nothing else. Rounds of both kinds alternate; each
// round trip is timed by the fluid, from handing over its load to holding the solid's answer.

#include "protocol/participant.hpp"
#include "protocol/session.hpp"
#include "protocol/socket_folder.hpp"
#include "protocol/sockets.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace {

using namespace duet::protocol;
namespace v1 = duet::v1;
using Clock = Session::Clock;

constexpr std::size_t nodes = 320;
constexpr std::size_t motion_bytes = nodes * 5 * sizeof(double);
constexpr std::size_t load_bytes = nodes * 3 * sizeof(double);
constexpr std::uint32_t windows_a_lease = 16;
constexpr std::uint64_t round_size = 128; // windows, then as many bare round trips
constexpr double window_length = 1e-3;    // s

class Solid final : public SolidSolver {
  public:
    std::string name() const override { return "benchmark solid"; }
    void configure(const v1::Configure&,
                   v1::Ready&,
                   std::vector<Chain>& chains,
                   InterfaceMotion& start) override {
        chains.resize(1);
        chains[0].closed = true;
        for (std::uint32_t i = 0; i < nodes; ++i)
            chains[0].nodes.push_back(i);
        start.position.assign(2 * nodes, 1.0);
        start.velocity.assign(2 * nodes, 0.5);
        start.temperature.assign(nodes, 300.0);
    }
    void advance(const Window&,
                 const InterfaceLoad& load,
                 InterfaceMotion& end,
                 v1::Report& report) override {
        end.temperature[0] = load.heat_flow[0];
        report.set_steps(1);
    }
    std::string save() const override { return ""; }
    void restore(const std::string&) override {}
    void finish() override {}
};

/// Keeps the time of each window's start; the time between two starts in one lease is a window.
class Fluid final : public FluidSolver {
  public:
    explicit Fluid(std::vector<double>& durations) : durations_(durations) {}
    std::string name() const override { return "benchmark fluid"; }
    void configure(const v1::Configure&,
                   const std::vector<Chain>&,
                   const InterfaceMotion&,
                   v1::Ready&) override {}
    void advance(const Window& window,
                 const InterfaceMotion& start,
                 const InterfaceMotion&,
                 InterfaceLoad& load,
                 v1::Report& report) override {
        const auto now = Clock::now();
        if (window.index % round_size != 0)
            durations_.push_back(std::chrono::duration<double, std::micro>(now - last_).count());
        last_ = now;
        load.force.resize(2 * nodes);
        load.heat_flow.resize(nodes);
        load.heat_flow[0] = start.temperature[0];
        report.set_steps(1);
    }
    std::string save() const override { return ""; }
    void restore(const std::string&) override {}
    void finish() override {}

  private:
    std::vector<double>& durations_;
    Clock::time_point last_{};
};

void wait_for(zmq::socket_t& socket, short events) {
    zmq::pollitem_t item{socket.handle(), 0, events, 0};
    if (zmq::poll(&item, 1, std::chrono::seconds(10)) == 0)
        throw std::runtime_error("The other process of the benchmark is silent.");
}

/// The solid's end of the bare round trips.
void echo(const std::string& address, std::uint64_t count) {
    zmq::context_t context;
    zmq::socket_t socket = bounded_socket(context, zmq::socket_type::pair);
    socket.connect(address);
    zmq::message_t in;
    for (std::uint64_t i = 0; i < count; ++i) {
        wait_for(socket, ZMQ_POLLIN);
        (void)socket.recv(in);
        zmq::message_t out(motion_bytes);
        std::memset(out.data(), 1, motion_bytes);
        (void)socket.send(out, zmq::send_flags::none);
    }
}

void bare_round(zmq::socket_t& socket, std::vector<double>& durations) {
    zmq::message_t in;
    for (std::uint64_t i = 0; i < round_size; ++i) {
        const auto start = Clock::now();
        zmq::message_t out(load_bytes);
        std::memset(out.data(), 1, load_bytes);
        (void)socket.send(out, zmq::send_flags::none);
        wait_for(socket, ZMQ_POLLIN);
        (void)socket.recv(in);
        durations.push_back(
            std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    }
}

/// The orchestrator's part, reduced to what leads two solvers that never fail.
class Lead {
  public:
    Lead(Session& session, const SocketFolder& folder) : session_(session) {
        for (int i = 0; i < 2; ++i)
            next();
        for (const v1::Role role : {v1::ROLE_SOLID, v1::ROLE_FLUID}) {
            v1::ToSolver message;
            v1::Configure& configure = *message.mutable_configure();
            *configure.mutable_version() = version();
            configure.set_run_id(1);
            configure.set_role(role);
            configure.set_peer_address(folder.address("data"));
            configure.set_peer_bind(role == v1::ROLE_SOLID);
            configure.set_heartbeat_interval(1);
            configure.set_timeout(10);
            session.send(role, message);
        }
        for (int i = 0; i < 2; ++i)
            next();
    }

    /// A round of windows; leases go out before the last one is used up.
    void play() {
        const std::uint64_t end = leased_ + round_size;
        while (closed() < end) {
            while (leased_ < end && leased_ - closed() <= windows_a_lease)
                lease();
            ++reported_.at(next());
        }
    }

    void finish() {
        for (const v1::Role role : {v1::ROLE_SOLID, v1::ROLE_FLUID}) {
            v1::ToSolver message;
            message.mutable_finish();
            session_.send(role, message);
        }
        for (int i = 0; i < 2; ++i)
            next();
    }

  private:
    void lease() {
        v1::ToSolver message;
        v1::Lease& lease = *message.mutable_lease();
        lease.set_first(leased_);
        lease.set_count(windows_a_lease);
        lease.set_time(static_cast<double>(leased_) * window_length);
        lease.set_length(window_length);
        for (const v1::Role role : {v1::ROLE_SOLID, v1::ROLE_FLUID})
            session_.send(role, message);
        leased_ += windows_a_lease;
    }

    /// Windows that both have reported.
    std::uint64_t closed() const {
        return std::min(reported_.at(v1::ROLE_SOLID), reported_.at(v1::ROLE_FLUID));
    }

    v1::Role next() {
        for (;;) {
            const auto event = session_.next(Clock::now() + std::chrono::seconds(10));
            if (!event || event->kind != Event::Kind::message || event->message.has_failed())
                throw std::runtime_error("The benchmark's run failed: "
                                         + (event ? event->text + event->message.failed().text()
                                                  : std::string("silence.")));
            if (!event->message.has_heartbeat())
                return event->role;
        }
    }

    Session& session_;
    std::uint64_t leased_ = 0;
    std::map<v1::Role, std::uint64_t> reported_{{v1::ROLE_SOLID, 0}, {v1::ROLE_FLUID, 0}};
};

double median(std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

} // namespace

int main(int argc, char** argv) {
    std::uint64_t rounds = 80;
    if (argc == 3 && std::string(argv[1]) == "--windows")
        rounds = std::max<std::uint64_t>(1, std::strtoull(argv[2], nullptr, 10) / round_size);
    const SocketFolder folder;
    const std::string control = folder.address("control");
    const std::string bare = folder.address("bare");

    const pid_t child = fork(); // before any thread or context exists
    if (child == 0) {
        std::thread echoing([&] { echo(bare, rounds * round_size); });
        Solid solid;
        const int status = participate(solid, {control, 10});
        echoing.join();
        _exit(status);
    }
    std::vector<double> windows;
    std::vector<double> round_trips;
    int fluid_status = 1;
    {
        Session session(control);
        std::thread playing([&] {
            Fluid fluid(windows);
            fluid_status = participate(fluid, {control, 10});
        });
        zmq::context_t context;
        zmq::socket_t socket = bounded_socket(context, zmq::socket_type::pair);
        socket.bind(bare);
        wait_for(socket, ZMQ_POLLOUT);
        Lead lead(session, folder);
        for (std::uint64_t i = 0; i < rounds; ++i) {
            lead.play();
            bare_round(socket, round_trips);
        }
        lead.finish();
        playing.join();
    }
    int solid_status = 1;
    waitpid(child, &solid_status, 0);
    if (fluid_status != 0 || solid_status != 0) {
        std::fprintf(stderr, "A participant of the benchmark failed.\n");
        return 1;
    }
    const double window_median = median(windows);
    const double bare_median = median(round_trips);
    std::printf("one exchange of %zu interface nodes both ways (%zu + %zu bytes)\n",
                nodes,
                load_bytes,
                motion_bytes);
    std::printf("%-28s %12s %12s\n", "", "median us", "best us");
    std::printf("%-28s %12.1f %12.1f\n", "window of the protocol", window_median, windows.front());
    std::printf("%-28s %12.1f %12.1f\n", "bare PAIR round trip", bare_median, round_trips.front());
    std::printf("ratio of the medians %.2f\n", window_median / bare_median);
    return 0;
}
