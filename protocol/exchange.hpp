// The data plane: one PAIR socket straight between the two solvers.
//
// Every wait also listens to the orchestrator (Abort) and to the connection itself, so the loss of
// either ends it within milliseconds; Configure.timeout bounds the wait for a peer that is merely
// silent.

#pragma once

#include "protocol/control_link.hpp"
#include "protocol/interface_codec.hpp"
#include "protocol/sockets.hpp"

namespace duet::protocol {

class Exchange {
  public:
    /// Binds or connects Configure.peer_address. Throws Error(PEER) if that fails.
    Exchange(zmq::context_t& context, const v1::Configure& configure, ControlLink& control);

    /// The solid's chains and start, once, before window 0.
    void send_start(const std::vector<Chain>& chains, const InterfaceMotion& start);
    void receive_start(std::vector<Chain>& chains, InterfaceMotion& start);

    /// One of the two exchanges of a window; see interface_codec.hpp for what is refused.
    template <typename Data>
    void send(const Window& window, const Data& data) {
        encode(stamp(window), size_, data, outgoing_);
        put();
    }
    template <typename Data>
    void receive(const Window& window, Data& data) {
        take();
        decode(incoming_, stamp(window), size_, data);
    }

    /// Tells the peer that this side ends, so that it need not wait; never blocks or throws.
    void tell_failed(const v1::Failed& failed) noexcept;

    const InterfaceSize& size() const { return size_; }

    /// s spent waiting for the peer since the start
    double waited() const { return waited_; }

  private:
    Stamp stamp(const Window& window) const { return {run_id_, false, window}; }
    void put();
    void take();
    template <typename Attempt>
    void wait_until(Attempt attempt);
    void sleep_until_news(ControlLink::Clock::time_point deadline);
    bool lost() const;

    ControlLink& control_;
    std::string peer_; // "solid" or "fluid"
    std::uint64_t run_id_;
    std::chrono::duration<double> timeout_;
    InterfaceSize size_;
    v1::ToPeer outgoing_; // reused: their buffers keep their size
    v1::ToPeer incoming_;
    zmq::message_t frame_;
    double waited_ = 0;
    int peer_descriptor_ = -1; // of the connection, known from the first message on
    zmq::socket_t pair_;
    ConnectionMonitor monitor_;
    zmq::socket_t record_; // PUSH; only if the exchanges are recorded
};

} // namespace duet::protocol
