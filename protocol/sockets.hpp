// What every socket of the protocol has in common: bounded waits, and the news of a lost
// connection.

#pragma once

#include <chrono>
#include <set>
#include <string>

#include <zmq.hpp>

namespace duet::protocol {

/// A socket that never blocks for ever: a send or receive gives up after a second, and closing it
/// flushes what was sent for at most a second.
zmq::socket_t bounded_socket(zmq::context_t& context, zmq::socket_type type);

/// Knows which connections of a socket are up. Made before the socket is bound or connected,
/// destroyed before it, and used by the same thread.
class ConnectionMonitor {
  public:
    ConnectionMonitor(zmq::context_t& context, zmq::socket_t& watched);
    ~ConnectionMonitor();
    ConnectionMonitor(const ConnectionMonitor&) = delete;
    ConnectionMonitor& operator=(const ConnectionMonitor&) = delete;

    /// Readable when there is news; then call update().
    zmq::socket_ref socket() { return news_; }
    void update();

    /// Whether the connection with this descriptor (see connection_of) has gone down again.
    bool closed(int descriptor) const { return closed_.contains(descriptor); }
    bool any_open() const { return !open_.empty(); }

    /// Whether some connection got past its greeting.
    bool ever_open() const { return greeted_; }

  private:
    zmq::socket_t& watched_;
    zmq::socket_t news_;
    std::set<int> open_;
    std::set<int> closed_;
    bool greeted_ = false;
};

/// The descriptor of the connection over which a message came; -1 if it came within the process.
int connection_of(zmq::message_t& message);

/// Milliseconds until `deadline`, rounded up, at least 0, for zmq::poll.
std::chrono::milliseconds until(std::chrono::steady_clock::time_point deadline);

} // namespace duet::protocol
