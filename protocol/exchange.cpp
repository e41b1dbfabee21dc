#include "protocol/exchange.hpp"

#include "protocol/version.hpp"

#include <algorithm>
#include <array>
#include <poll.h>

namespace duet::protocol {

Exchange::Exchange(zmq::context_t& context, const v1::Configure& configure, ControlLink& control)
    : control_(control),
      peer_(name_of(configure.role() == v1::ROLE_SOLID ? v1::ROLE_FLUID : v1::ROLE_SOLID)),
      run_id_(configure.run_id()), timeout_(configure.timeout()),
      pair_(bounded_socket(context, zmq::socket_type::pair)), monitor_(context, pair_) {
    const std::string& address = configure.peer_address();
    try {
        if (configure.peer_bind())
            pair_.bind(address);
        else
            pair_.connect(address);
        if (configure.record()) {
            record_ = bounded_socket(context, zmq::socket_type::push);
            record_.connect(configure.record_address());
        }
    } catch (const zmq::error_t& error) {
        throw Error(v1::Failed::PEER,
                    "Cannot open the data plane '" + address + "' or the record '"
                        + configure.record_address() + "': " + error.what() + ".");
    }
}

void Exchange::send_start(const std::vector<Chain>& chains, const InterfaceMotion& start) {
    size_ = encode_start({run_id_, true, {}}, chains, start, outgoing_);
    put();
}

void Exchange::receive_start(std::vector<Chain>& chains, InterfaceMotion& start) {
    take();
    size_ = decode_start(incoming_, {run_id_, true, {}}, chains, start);
}

void Exchange::tell_failed(const v1::Failed& failed) noexcept {
    try {
        monitor_.update();
        if (lost()) {
            pair_.set(zmq::sockopt::linger, 0); // nobody is there for the last words
            return;
        }
        *outgoing_.mutable_failed() = failed;
        zmq::message_t frame(outgoing_.ByteSizeLong());
        outgoing_.SerializeToArray(frame.data(), static_cast<int>(frame.size()));
        (void)pair_.send(frame, zmq::send_flags::dontwait);
    } catch (const std::exception&) {
        // The peer then learns it from the closed connection.
    }
}

void Exchange::put() {
    frame_.rebuild(outgoing_.ByteSizeLong());
    outgoing_.SerializeToArray(frame_.data(), static_cast<int>(frame_.size()));
    zmq::message_t copy;
    if (record_)
        copy.copy(frame_); // shares the bytes
    wait_until([&] { return pair_.send(frame_, zmq::send_flags::dontwait).has_value(); });
    if (record_ && !record_.send(copy, zmq::send_flags::none))
        throw Error(v1::Failed::PEER,
                    "The orchestrator does not take the record of the exchanges; its disk may be "
                    "full or too slow.");
}

void Exchange::take() {
    wait_until([&] { return pair_.recv(frame_, zmq::recv_flags::dontwait).has_value(); });
    if (frame_.more())
        throw Error(v1::Failed::PEER, "The " + peer_ + " sent a message of several frames.");
    peer_descriptor_ = connection_of(frame_);
    if (!incoming_.ParseFromArray(frame_.data(), static_cast<int>(frame_.size())))
        throw Error(v1::Failed::PEER,
                    "The " + peer_ + " sent " + std::to_string(frame_.size())
                        + " bytes that are no message of the protocol.");
}

template <typename Attempt>
void Exchange::wait_until(Attempt attempt) {
    if (attempt())
        return;
    const auto start = ControlLink::Clock::now();
    const auto deadline =
        start + std::chrono::duration_cast<ControlLink::Clock::duration>(timeout_);
    const char* const phase = control_.pulse().phase.exchange("waiting for the other solver");
    control_.heed_after_send();
    for (;;) {
        if (lost())
            throw Error(v1::Failed::PEER,
                        "The " + peer_ + " has closed its connection: its process has ended.");
        if (ControlLink::Clock::now() >= deadline)
            throw Error(v1::Failed::PEER,
                        "The " + peer_ + " has been silent for " + std::to_string(timeout_.count())
                            + " s; it hangs, or its windows take longer than the timeout.");
        sleep_until_news(std::min(deadline, control_.flush_due()));
        if (attempt())
            break;
        control_.flush_if_due();
        control_.heed();
        monitor_.update();
        if (attempt()) // what the peer sent before it went is in the pipe before the news of that
            break;
    }
    control_.pulse().phase = phase;
    waited_ += std::chrono::duration<double>(ControlLink::Clock::now() - start).count();
}

/// A plain poll of the three sockets' descriptors: zmq::poll would ask each of them several times.
/// It is right because all that a descriptor may have told of before was looked at since the last
/// sleep.
void Exchange::sleep_until_news(ControlLink::Clock::time_point deadline) {
    std::array<pollfd, 3> descriptors{{{pair_.get(zmq::sockopt::fd), POLLIN, 0},
                                       {control_.socket().get(zmq::sockopt::fd), POLLIN, 0},
                                       {monitor_.socket().get(zmq::sockopt::fd), POLLIN, 0}}};
    ::poll(descriptors.data(), descriptors.size(), static_cast<int>(until(deadline).count()));
}

bool Exchange::lost() const {
    if (peer_descriptor_ != -1)
        return monitor_.closed(peer_descriptor_);
    return monitor_.ever_open() && !monitor_.any_open();
}

} // namespace duet::protocol
