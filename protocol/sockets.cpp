#include "protocol/sockets.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>

namespace duet::protocol {

namespace {

constexpr int patience = 1000; // ms

} // namespace

zmq::socket_t bounded_socket(zmq::context_t& context, zmq::socket_type type) {
    zmq::socket_t socket(context, type);
    socket.set(zmq::sockopt::linger, patience);
    socket.set(zmq::sockopt::sndtimeo, patience);
    socket.set(zmq::sockopt::rcvtimeo, patience);
    socket.set(zmq::sockopt::reconnect_ivl, 5); // ms; the other side may bind a little later
    return socket;
}

ConnectionMonitor::ConnectionMonitor(zmq::context_t& context, zmq::socket_t& watched)
    : watched_(watched), news_(bounded_socket(context, zmq::socket_type::pair)) {
    static std::atomic<unsigned> count{0};
    const std::string address = "inproc://monitor-" + std::to_string(count++);
    constexpr int events = ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_CONNECTED | ZMQ_EVENT_DISCONNECTED
                           | ZMQ_EVENT_HANDSHAKE_SUCCEEDED;
    if (zmq_socket_monitor(watched_.handle(), address.c_str(), events) != 0)
        throw zmq::error_t();
    news_.connect(address);
    update(); // news that comes before a first look would not wake a poll of the descriptor
}

ConnectionMonitor::~ConnectionMonitor() {
    // An open monitor socket would hang the end of the context.
    zmq_socket_monitor(watched_.handle(), nullptr, 0);
}

void ConnectionMonitor::update() {
    zmq::message_t event;
    zmq::message_t endpoint;
    while (news_.recv(event, zmq::recv_flags::dontwait)) {
        (void)news_.recv(endpoint, zmq::recv_flags::none);
        // 16 bits of event, 32 bits of value (a descriptor), unaligned.
        std::uint16_t kind = 0;
        std::int32_t value = 0;
        std::memcpy(&kind, event.data(), sizeof kind);
        std::memcpy(&value, event.data<char>() + sizeof kind, sizeof value);
        if (kind == ZMQ_EVENT_HANDSHAKE_SUCCEEDED)
            greeted_ = true;
        else if (kind == ZMQ_EVENT_DISCONNECTED) {
            open_.erase(value);
            closed_.insert(value);
        } else {
            open_.insert(value);
            closed_.erase(value); // the descriptor of another connection by now
        }
    }
}

int connection_of(zmq::message_t& message) {
    return zmq_msg_get(message.handle(), ZMQ_SRCFD);
}

std::chrono::milliseconds until(std::chrono::steady_clock::time_point deadline) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    return std::max(left, std::chrono::milliseconds(0));
}

} // namespace duet::protocol
