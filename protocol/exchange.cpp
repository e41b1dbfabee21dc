#include "protocol/exchange.hpp"

#include "protocol/version.hpp"

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
    while (!pair_.send(frame_, zmq::send_flags::dontwait))
        wait(ZMQ_POLLOUT);
    if (record_ && !record_.send(copy, zmq::send_flags::none))
        throw Error(v1::Failed::PEER,
                    "The orchestrator does not take the record of the exchanges; its disk may be "
                    "full or too slow.");
}

void Exchange::take() {
    while (!pair_.recv(frame_, zmq::recv_flags::dontwait))
        wait(ZMQ_POLLIN);
    if (frame_.more())
        throw Error(v1::Failed::PEER, "The " + peer_ + " sent a message of several frames.");
    peer_descriptor_ = connection_of(frame_);
    if (!incoming_.ParseFromArray(frame_.data(), static_cast<int>(frame_.size())))
        throw Error(v1::Failed::PEER,
                    "The " + peer_ + " sent " + std::to_string(frame_.size())
                        + " bytes that are no message of the protocol.");
}

/// Until the pair can be read or written.
void Exchange::wait(short events) {
    const auto start = ControlLink::Clock::now();
    const auto deadline =
        start + std::chrono::duration_cast<ControlLink::Clock::duration>(timeout_);
    const char* const phase = control_.pulse().phase.exchange("waiting for the other solver");
    for (;;) {
        // What the peer sent before it went is in the pipe before the news of its going.
        monitor_.update();
        if ((pair_.get(zmq::sockopt::events) & events) != 0)
            break;
        if (lost())
            throw Error(v1::Failed::PEER,
                        "The " + peer_ + " has closed its connection: its process has ended.");
        if (ControlLink::Clock::now() >= deadline)
            throw Error(v1::Failed::PEER,
                        "The " + peer_ + " has been silent for " + std::to_string(timeout_.count())
                            + " s; it hangs, or its windows take longer than the timeout.");
        zmq::pollitem_t items[] = {{pair_.handle(), 0, events, 0},
                                   {control_.socket().handle(), 0, ZMQ_POLLIN, 0},
                                   {monitor_.socket().handle(), 0, ZMQ_POLLIN, 0}};
        zmq::poll(items, 3, until(deadline));
        if (items[0].revents != 0)
            break;
        if (items[1].revents != 0)
            control_.heed();
    }
    control_.pulse().phase = phase;
    waited_ += std::chrono::duration<double>(ControlLink::Clock::now() - start).count();
}

bool Exchange::lost() const {
    if (peer_descriptor_ != -1)
        return !monitor_.open(peer_descriptor_);
    return monitor_.ever_open() && !monitor_.any_open();
}

} // namespace duet::protocol
