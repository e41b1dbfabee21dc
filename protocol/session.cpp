#include "protocol/session.hpp"

#include "protocol/sockets.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <fcntl.h>
#include <stdexcept>
#include <vector>

namespace duet::protocol {

namespace {

/// What the orchestrator knows of one solver: where it is in the states of coupling.proto.
struct Seat {
    enum class Phase { absent, configuring, ready, advancing, saving, restoring, finishing, ended };
    Phase phase = Phase::absent;
    std::string identity; // the ROUTER's name for its connection
    int descriptor = -1;  // of that connection
    std::string solver;   // its name
    Session::Clock::time_point heard{};
    std::uint64_t next_report = 0; // the next window it must report
    std::uint64_t leased = 0;      // one past the last window it may play

    bool present() const { return phase != Phase::absent && phase != Phase::ended; }
};

using Phase = Seat::Phase;
using Answer = v1::ToOrchestrator::MessageCase;

/// The messages a solver may send in each state, Failed and Heartbeat apart.
bool fits(Phase phase, Answer answer) {
    switch (phase) {
    case Phase::configuring:
        return answer == v1::ToOrchestrator::kReady;
    case Phase::advancing:
        return answer == v1::ToOrchestrator::kReport;
    case Phase::saving:
        return answer == v1::ToOrchestrator::kSaved;
    case Phase::restoring:
        return answer == v1::ToOrchestrator::kRestored;
    case Phase::finishing:
        return answer == v1::ToOrchestrator::kBye;
    default:
        return false;
    }
}

std::string kind_of(const v1::ToOrchestrator& message) {
    const auto* field = message.GetDescriptor()->FindFieldByNumber(message.message_case());
    return field == nullptr ? "nothing" : field->name();
}

zmq::socket_t bound(zmq::context_t& context, zmq::socket_type type, const std::string& address) {
    zmq::socket_t socket = bounded_socket(context, type);
    if (!address.empty())
        socket.bind(address);
    return socket;
}

} // namespace

struct Session::State {
    State(const std::string& address, const std::string& record_address)
        : router(bounded_socket(context, zmq::socket_type::router)), monitor(context, router),
          record(bound(context, zmq::socket_type::pull, record_address)) {
        router.set(zmq::sockopt::router_mandatory, true); // a send to nobody fails at once
        router.bind(address);
    }

    zmq::context_t context;
    zmq::socket_t router;
    ConnectionMonitor monitor;
    zmq::socket_t record;
    std::array<Seat, 3> seats; // by role
    std::vector<int> watched;
    std::deque<Event> pending; // read, not yet given

    Seat& seat(v1::Role role) { return seats.at(static_cast<std::size_t>(role)); }
    v1::Role role_at(const std::string& identity) const;
    bool transmit(const std::string& identity, const v1::ToSolver& message);
    std::optional<Event> next_now();
    std::optional<Event> next_message();
    std::optional<Event> next_exchange();
    std::optional<Event> next_loss();
    Event read(const std::string& identity, zmq::message_t& frame);
    Event greet(const std::string& identity, int descriptor, Event event);
    Event check(Event event);
    Event refuse(const std::string& identity, Event event, const std::string& sentence);
};

Session::Session(const std::string& address, const std::string& record_address) {
    try {
        state_ = std::make_unique<State>(address, record_address);
    } catch (const zmq::error_t& error) {
        throw std::runtime_error("Cannot listen at '" + address
                                 + (record_address.empty() ? "" : "' and '" + record_address)
                                 + "': " + error.what() + ".");
    }
}

Session::~Session() = default;

std::string Session::address() const {
    return state_->router.get(zmq::sockopt::last_endpoint);
}

std::string Session::record_address() const {
    return state_->record.get(zmq::sockopt::last_endpoint);
}

std::optional<Event> Session::next(Clock::time_point deadline) {
    for (;;) {
        if (auto event = state_->next_now())
            return event;
        std::vector<zmq::pollitem_t> items{{state_->router.handle(), 0, ZMQ_POLLIN, 0},
                                           {state_->monitor.socket().handle(), 0, ZMQ_POLLIN, 0},
                                           {state_->record.handle(), 0, ZMQ_POLLIN, 0}};
        const std::size_t sockets = items.size();
        for (const int descriptor : state_->watched)
            items.push_back({nullptr, descriptor, ZMQ_POLLIN, 0});
        if (zmq::poll(items, until(deadline)) == 0) {
            if (Clock::now() >= deadline)
                return std::nullopt;
            continue;
        }
        // What solvers sent counts before the news of a descriptor (the end of a process).
        if (auto event = state_->next_now())
            return event;
        for (std::size_t i = sockets; i < items.size(); ++i) {
            if (items[i].revents == 0)
                continue;
            if (fcntl(items[i].fd, F_GETFD) == -1) { // closed: it would be ready for ever
                unwatch(items[i].fd);
                continue;
            }
            Event event;
            event.kind = Event::Kind::descriptor;
            event.descriptor = items[i].fd;
            return event;
        }
    }
}

bool Session::send(v1::Role role, const v1::ToSolver& message) {
    Seat& seat = state_->seat(role);
    if (!seat.present() || !state_->transmit(seat.identity, message))
        return false;
    switch (message.message_case()) {
    case v1::ToSolver::kLease:
        if (seat.phase != Phase::advancing)
            seat.next_report = message.lease().first();
        seat.leased = message.lease().first() + message.lease().count();
        seat.phase = Phase::advancing;
        break;
    case v1::ToSolver::kSave:
        seat.phase = Phase::saving;
        break;
    case v1::ToSolver::kRestore:
        seat.phase = Phase::restoring;
        break;
    case v1::ToSolver::kFinish:
        seat.phase = Phase::finishing;
        break;
    case v1::ToSolver::kAbort:
        seat.phase = Phase::ended;
        break;
    default:
        break;
    }
    return true;
}

bool Session::connected(v1::Role role) const {
    return state_->seat(role).present();
}

Session::Clock::time_point Session::last_heard(v1::Role role) const {
    return state_->seat(role).heard;
}

void Session::watch(int descriptor) {
    state_->watched.push_back(descriptor);
}

void Session::unwatch(int descriptor) {
    std::erase(state_->watched, descriptor);
}

v1::Role Session::State::role_at(const std::string& identity) const {
    for (const v1::Role role : {v1::ROLE_SOLID, v1::ROLE_FLUID})
        if (const Seat& seat = seats[static_cast<std::size_t>(role)];
            seat.phase != Phase::absent && seat.identity == identity)
            return role;
    return v1::ROLE_UNSPECIFIED;
}

bool Session::State::transmit(const std::string& identity, const v1::ToSolver& message) {
    try {
        const std::string bytes = message.SerializeAsString();
        return router.send(zmq::buffer(identity), zmq::send_flags::sndmore)
               && router.send(zmq::buffer(bytes), zmq::send_flags::none);
    } catch (const zmq::error_t&) {
        return false; // router_mandatory: the connection is gone
    }
}

std::optional<Event> Session::State::next_now() {
    // The losses are noted before and told after the messages are read, so that all that a solver
    // sent comes first.
    monitor.update();
    if (auto event = next_message())
        return event;
    if (auto event = next_exchange())
        return event;
    return next_loss();
}

std::optional<Event> Session::State::next_message() {
    zmq::message_t identity;
    while (pending.empty() && router.recv(identity, zmq::recv_flags::dontwait)) {
        const std::string sender = identity.to_string();
        zmq::message_t frame;
        for (bool more = identity.more(); more; more = frame.more()) {
            (void)router.recv(frame, zmq::recv_flags::none);
            const v1::Role role = role_at(sender);
            const bool over = role != v1::ROLE_UNSPECIFIED && seat(role).phase == Phase::ended;
            Event event = read(sender, frame);
            // After its end, all that a solver can still tell is why it failed.
            if (!over || event.message.has_failed())
                pending.push_back(std::move(event));
        }
    }
    if (pending.empty())
        return std::nullopt;
    Event event = std::move(pending.front());
    pending.pop_front();
    return event;
}

Event Session::State::read(const std::string& identity, zmq::message_t& frame) {
    Event event;
    event.role = role_at(identity);
    if (event.role != v1::ROLE_UNSPECIFIED)
        seat(event.role).heard = Clock::now();
    if (!event.message.ParseFromArray(frame.data(), static_cast<int>(frame.size()))
        || event.message.message_case() == v1::ToOrchestrator::MESSAGE_NOT_SET) {
        event.kind = Event::Kind::garbage;
        event.message.Clear();
        event.text = "The " + name_of(event.role) + " sent " + std::to_string(frame.size())
                     + " bytes that are no message of the protocol.";
        return event;
    }
    if (event.message.has_hello())
        return greet(identity, connection_of(frame), std::move(event));
    return check(std::move(event));
}

Event Session::State::greet(const std::string& identity, int descriptor, Event event) {
    const v1::Hello& hello = event.message.hello();
    const std::string the_solver = "The " + name_of(hello.role()) + " " + hello.solver();
    if (event.role != v1::ROLE_UNSPECIFIED)
        return refuse(identity, std::move(event), the_solver + " said Hello twice.");
    if (hello.role() != v1::ROLE_SOLID && hello.role() != v1::ROLE_FLUID)
        return refuse(
            identity, std::move(event), the_solver + " says it is neither solid nor fluid.");
    Seat& seat = this->seat(hello.role());
    if (seat.phase != Phase::absent)
        return refuse(identity,
                      std::move(event),
                      the_solver + " is the second of its role; it is not served.");
    event.role = hello.role();
    if (!compatible(version(), hello.version()))
        return refuse(
            identity,
            std::move(event),
            incompatibility("the orchestrator", version(), hello.solver(), hello.version()));
    seat.phase = Phase::configuring;
    seat.identity = identity;
    seat.descriptor = descriptor;
    seat.solver = hello.solver();
    seat.heard = Clock::now();
    return event;
}

Event Session::State::check(Event event) {
    if (event.role == v1::ROLE_UNSPECIFIED) {
        event.kind = Event::Kind::garbage;
        event.text = "A stranger sent " + kind_of(event.message) + " without Hello.";
        return event;
    }
    if (event.message.has_heartbeat())
        return event;
    Seat& seat = this->seat(event.role);
    if (event.message.has_failed()) {
        seat.phase = Phase::ended;
        return event;
    }
    if (seat.phase == Phase::ended)
        return event;
    const std::string the_solver = "The " + name_of(event.role) + " " + seat.solver;
    if (!fits(seat.phase, event.message.message_case()))
        return refuse(seat.identity,
                      std::move(event),
                      the_solver + " sent " + kind_of(event.message) + " out of turn.");
    if (event.message.has_report()) {
        const std::uint64_t window = event.message.report().window();
        if (window != seat.next_report)
            return refuse(seat.identity,
                          std::move(event),
                          the_solver + " reported window " + std::to_string(window) + " where "
                              + std::to_string(seat.next_report) + " was due.");
        if (++seat.next_report == seat.leased)
            seat.phase = Phase::ready;
        return event;
    }
    seat.phase = event.message.has_bye() ? Phase::ended : Phase::ready;
    return event;
}

Event Session::State::refuse(const std::string& identity,
                             Event event,
                             const std::string& sentence) {
    event.kind = Event::Kind::refused;
    event.text = sentence;
    v1::ToSolver message;
    message.mutable_abort()->set_text("The orchestrator ends the run: " + event.text);
    transmit(identity, message);
    if (event.role != v1::ROLE_UNSPECIFIED && seat(event.role).identity == identity)
        seat(event.role).phase = Phase::ended;
    return event;
}

std::optional<Event> Session::State::next_exchange() {
    zmq::message_t frame;
    if (!record.recv(frame, zmq::recv_flags::dontwait))
        return std::nullopt;
    Event event;
    event.kind = Event::Kind::exchange;
    if (frame.more()
        || !event.exchange.ParseFromArray(frame.data(), static_cast<int>(frame.size())))
        event.kind = Event::Kind::garbage;
    event.role = event.exchange.has_motion() ? v1::ROLE_SOLID
                 : event.exchange.has_load() ? v1::ROLE_FLUID
                                             : v1::ROLE_UNSPECIFIED;
    event.text = event.kind == Event::Kind::garbage
                     ? "The record of the exchanges got bytes that are no message of the protocol."
                     : "";
    return event;
}

std::optional<Event> Session::State::next_loss() {
    for (const v1::Role role : {v1::ROLE_SOLID, v1::ROLE_FLUID}) {
        Seat& seat = this->seat(role);
        if (!seat.present() || !monitor.closed(seat.descriptor))
            continue;
        seat.phase = Phase::ended;
        Event event;
        event.kind = Event::Kind::disconnected;
        event.role = role;
        event.text = "The " + name_of(role) + " (" + seat.solver
                     + ") closed its connection before the end of the run: its process has ended.";
        return event;
    }
    return std::nullopt;
}

} // namespace duet::protocol
