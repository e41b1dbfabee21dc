#include "protocol/control_link.hpp"

#include "protocol/solver.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <unistd.h>

namespace duet::protocol {

namespace {

constexpr auto grace = std::chrono::seconds(2);

// Over the inproc pair, a single frame is a message as it travels; an empty one from the solver's
// thread means stop, two frames from the link's thread mean that the orchestrator is gone (the
// second says how).
zmq::message_t serialize(const v1::ToOrchestrator& message) {
    zmq::message_t frame(message.ByteSizeLong());
    message.SerializeToArray(frame.data(), static_cast<int>(frame.size()));
    return frame;
}

zmq::socket_t inproc_end(zmq::context_t& context) {
    zmq::socket_t socket = bounded_socket(context, zmq::socket_type::pair);
    socket.set(zmq::sockopt::sndhwm, 0);
    socket.set(zmq::sockopt::rcvhwm, 0);
    return socket;
}

} // namespace

ControlLink::ControlLink(zmq::context_t& context, const std::string& address)
    : near_(inproc_end(context)), far_(inproc_end(context)),
      dealer_(bounded_socket(context, zmq::socket_type::dealer)), monitor_(context, dealer_) {
    near_.bind("inproc://control");
    far_.connect("inproc://control");
    try {
        dealer_.connect(address);
    } catch (const zmq::error_t& error) {
        throw Error(v1::Failed::PEER,
                    "Cannot connect to '" + address + "' (" + error.what()
                        + "); give the address that the orchestrator printed, ipc://... or "
                          "tcp://host:port.");
    }
    thread_ = std::thread([this] { run(); });
}

ControlLink::~ControlLink() {
    (void)near_.send(zmq::message_t(), zmq::send_flags::none);
    thread_.join();
    monitor_.update();
    if (lost())
        dealer_.set(zmq::sockopt::linger, 0); // nobody is there for the last words
}

bool ControlLink::lost() const {
    return monitor_.ever_open() && !monitor_.any_open();
}

void ControlLink::send(const v1::ToOrchestrator& message) {
    posted_.push_back(serialize(message));
    flush();
}

void ControlLink::post(const v1::ToOrchestrator& message) {
    posted_.push_back(serialize(message));
    flush_if_due();
}

ControlLink::Clock::time_point ControlLink::flush_due() const {
    return posted_.empty() ? Clock::time_point::max() : flushed_ + post_patience;
}

void ControlLink::flush_if_due() {
    if (Clock::now() >= flush_due())
        flush();
}

void ControlLink::flush() {
    if (posted_.empty())
        return;
    for (std::size_t i = 0; i < posted_.size(); ++i)
        (void)near_.send(posted_[i],
                         i + 1 < posted_.size() ? zmq::send_flags::sndmore : zmq::send_flags::none);
    posted_.clear();
    flushed_ = Clock::now();
    sent_ = true;
}

std::optional<v1::ToSolver> ControlLink::receive(Clock::time_point deadline) {
    flush(); // the orchestrator may wait for just these
    heed();
    while (inbox_.empty()) {
        if (Clock::now() >= deadline)
            return std::nullopt;
        zmq::pollitem_t item{near_.handle(), 0, ZMQ_POLLIN, 0};
        zmq::poll(&item, 1, until(deadline));
        heed();
    }
    std::optional<v1::ToSolver> message = std::move(inbox_.front());
    inbox_.pop_front();
    return message;
}

void ControlLink::heed() {
    sent_ = false;
    zmq::message_t frame;
    while (near_.recv(frame, zmq::recv_flags::dontwait)) {
        if (frame.more()) {
            (void)near_.recv(frame, zmq::recv_flags::none);
            throw Aborted(frame.to_string());
        }
        v1::ToSolver& message = inbox_.emplace_back();
        if (!message.ParseFromArray(frame.data(), static_cast<int>(frame.size())))
            throw Error(v1::Failed::PEER,
                        "The orchestrator sent bytes that are no message of the protocol.");
        if (message.has_abort())
            throw Aborted(message.abort().text());
    }
}

void ControlLink::run() {
    Clock::time_point last_beat{};
    while (!stopping_) {
        const std::chrono::duration<double> interval(pulse_.interval.load());
        const auto next_beat = last_beat + std::chrono::duration_cast<Clock::duration>(interval);
        if (Clock::now() >= next_beat && !ending_) {
            beat();
            last_beat = Clock::now();
            continue;
        }
        zmq::pollitem_t items[] = {{far_.handle(), 0, ZMQ_POLLIN, 0},
                                   {monitor_.socket().handle(), 0, ZMQ_POLLIN, 0},
                                   {dealer_.handle(), 0, ZMQ_POLLIN, 0}};
        // Once ending, nothing more can come from the orchestrator that matters.
        zmq::poll(items, ending_ ? 1 : 3, until(ending_ ? last_moment_ : next_beat));
        forward_to_orchestrator();
        if (ending_ && !stopping_ && Clock::now() >= last_moment_) {
            std::fprintf(stderr,
                         "%s The solver did not come back in time; its process ends.\n",
                         reason_.c_str());
            _exit(1);
        }
        if (!ending_)
            forward_to_solver();
    }
}

void ControlLink::forward_to_orchestrator() {
    zmq::message_t frame;
    while (!stopping_ && far_.recv(frame, zmq::recv_flags::dontwait)) {
        const auto more = frame.more() ? zmq::send_flags::sndmore : zmq::send_flags::none;
        if (frame.size() == 0)
            stopping_ = true;
        else if (!ending_ && !dealer_.send(frame, more))
            end("The orchestrator takes no messages; it hangs or was stopped.");
    }
}

void ControlLink::forward_to_solver() {
    monitor_.update();
    const bool gone = lost();
    zmq::message_t frame;
    while (!ending_ && dealer_.recv(frame, zmq::recv_flags::dontwait)) {
        v1::ToSolver message;
        if (message.ParseFromArray(frame.data(), static_cast<int>(frame.size()))
            && message.has_abort())
            end(message.abort().text());
        else
            (void)far_.send(frame, zmq::send_flags::none);
    }
    if (gone && !ending_)
        end("The orchestrator has closed the connection.");
}

void ControlLink::beat() {
    // Before the connection is up, heartbeats would only pile up.
    if (!monitor_.any_open())
        return;
    v1::ToOrchestrator message;
    v1::Heartbeat& heartbeat = *message.mutable_heartbeat();
    heartbeat.set_window(pulse_.window);
    heartbeat.set_time(pulse_.time);
    heartbeat.set_phase(pulse_.phase);
    (void)dealer_.send(serialize(message), zmq::send_flags::dontwait);
}

void ControlLink::end(const std::string& reason) {
    ending_ = true;
    reason_ = reason;
    last_moment_ = Clock::now() + grace;
    constexpr std::string_view gone = "gone";
    (void)far_.send(zmq::buffer(gone), zmq::send_flags::sndmore);
    (void)far_.send(zmq::buffer(reason), zmq::send_flags::none);
}

} // namespace duet::protocol
