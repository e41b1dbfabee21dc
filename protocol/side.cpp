#include "protocol/side.hpp"

#include <cmath>
#include <utility>

namespace duet::protocol {

namespace {

/// A checkpoint's copy of interface data bears no run, and the time it stands for.
Stamp checkpoint_stamp(const v1::Checkpoint& checkpoint, double time, double length) {
    return {0, false, {checkpoint.window(), time, length}};
}

/// The end of the window from its start and the state one window `before`: acceleration and rate of
/// the temperature go on as they were, a = (v1 - v0)/span, x = x1 + w v1 + w^2/2 a, v = v1 + w a.
/// Before the first window there is none, and both are zero.
void predict(const InterfaceMotion& before,
             const InterfaceMotion& start,
             const Window& window,
             InterfaceMotion& end) {
    const double span = start.time - before.time;
    const double w = window.length, per_span = span > 0 ? 1 / span : 0;
    end = start; // same sizes: no allocation after the first window
    end.time = window.time + w;
    for (std::size_t i = 0; i < end.position.size(); ++i) {
        const double acceleration = per_span * (start.velocity[i] - before.velocity[i]);
        end.position[i] += w * start.velocity[i] + 0.5 * w * w * acceleration;
        end.velocity[i] += w * acceleration;
    }
    for (std::size_t i = 0; i < end.temperature.size(); ++i)
        end.temperature[i] += w * per_span * (start.temperature[i] - before.temperature[i]);
}

} // namespace

void SolidSide::configure(const v1::Configure& configure, Exchange* exchange, v1::Ready& ready) {
    std::vector<Chain> chains;
    solid_.configure(configure, ready, chains, motion_);
    motion_.time = 0;
    if (exchange != nullptr) {
        exchange->send_start(chains, motion_);
        size_ = exchange->size();
    }
    ready.set_nodes(size_.nodes);
    ready.set_segments(size_.segments);
    load_.force.assign(2 * size_.nodes, 0);
    load_.heat_flow.assign(size_.segments, 0);
}

void SolidSide::receive(const Window& window, Exchange& exchange) {
    exchange.receive(window, load_);
}

void SolidSide::advance(const Window& window, v1::Report& report) {
    solid_.advance(window, over(window), motion_, report);
    motion_.time = window.time + window.length;
}

/// The last load, as the mean over this window that brings the same impulse and heat. With the
/// fluid first it is this window's own; else it comes from the window before, which may have been
/// longer or shorter.
const InterfaceLoad& SolidSide::over(const Window& window) {
    if (load_.length == window.length)
        return load_;
    spread_ = load_;
    spread_.time = window.time;
    spread_.length = window.length;
    const double ratio = load_.length / window.length;
    for (double& force : spread_.force)
        force *= ratio;
    for (double& flow : spread_.heat_flow)
        flow *= ratio;
    return spread_;
}

void SolidSide::send(const Window& window, Exchange& exchange) {
    exchange.send(window, motion_);
}

void SolidSide::store(v1::Checkpoint& checkpoint) const {
    v1::ToPeer message;
    encode(checkpoint_stamp(checkpoint, load_.time, load_.length), size_, load_, message);
    checkpoint.mutable_load()->Swap(message.mutable_load());
}

void SolidSide::restore(const v1::Checkpoint& checkpoint) {
    v1::ToPeer message;
    *message.mutable_load() = checkpoint.load();
    const v1::InterfaceLoad& load = checkpoint.load();
    decode(message, checkpoint_stamp(checkpoint, load.time(), load.length()), size_, load_);
}

void FluidSide::configure(const v1::Configure& configure, Exchange* exchange, v1::Ready& ready) {
    std::vector<Chain> chains;
    if (exchange != nullptr) {
        exchange->receive_start(chains, latest_);
        size_ = exchange->size();
    }
    previous_ = latest_;
    load_.force.assign(2 * size_.nodes, 0);
    load_.heat_flow.assign(size_.segments, 0);
    load_before_ = load_;
    end_is_known_ = end_is_known(configure.schedule());
    solid_lags_ = acts(configure.schedule(), v1::ROLE_FLUID).front() == Act::advance
                  && acts(configure.schedule(), v1::ROLE_SOLID).front() == Act::advance;
    fluid_.configure(configure, chains, latest_, ready);
    ready.set_nodes(size_.nodes);
    ready.set_segments(size_.segments);
}

void FluidSide::receive(const Window& window, Exchange& exchange) {
    std::swap(previous_, latest_);
    exchange.receive(window, latest_);
    book_work(window);
}

/// The motion that has just come was made under the load that was sent last, or, where both advance
/// at once, under the one before it; spread over the window as the solid spreads it
/// (SolidSide::over).
void FluidSide::book_work(const Window& window) {
    const InterfaceLoad& load = solid_lags_ ? load_before_ : load_;
    const double ratio = load.length / window.length;
    for (std::size_t i = 0; i < load.force.size(); ++i) {
        const double work = ratio * load.force[i] * (latest_.position[i] - previous_.position[i]);
        work_of_loads_ += work;
        exchanged_work_ += std::abs(work);
    }
}

void FluidSide::advance(const Window& window, v1::Report& report) {
    if (solid_lags_) {
        std::swap(load_before_, load_);
    }
    load_.time = window.time;
    load_.length = window.length;
    if (end_is_known_) {
        fluid_.advance(window, previous_, latest_, load_, report);
    } else {
        predict(previous_, latest_, window, guess_);
        fluid_.advance(window, latest_, guess_, load_, report);
    }
    report.mutable_ledger()->set_work_of_loads(work_of_loads_);
    report.mutable_ledger()->set_exchanged_work(exchanged_work_);
}

void FluidSide::send(const Window& window, Exchange& exchange) {
    exchange.send(window, load_);
}

void FluidSide::store(v1::Checkpoint& checkpoint) const {
    v1::ToPeer message;
    encode(checkpoint_stamp(checkpoint, latest_.time, 0), size_, latest_, message);
    checkpoint.mutable_motion()->Swap(message.mutable_motion());
    encode(checkpoint_stamp(checkpoint, previous_.time, 0), size_, previous_, message);
    checkpoint.mutable_motion_before()->Swap(message.mutable_motion());
    encode(checkpoint_stamp(checkpoint, load_.time, load_.length), size_, load_, message);
    checkpoint.mutable_load()->Swap(message.mutable_load());
    checkpoint.set_work_of_loads(work_of_loads_);
    checkpoint.set_exchanged_work(exchanged_work_);
}

void FluidSide::restore(const v1::Checkpoint& checkpoint) {
    v1::ToPeer message;
    *message.mutable_motion() = checkpoint.motion();
    decode(message, checkpoint_stamp(checkpoint, checkpoint.motion().time(), 0), size_, latest_);
    const double before = checkpoint.motion_before().time();
    *message.mutable_motion() = checkpoint.motion_before();
    decode(message, checkpoint_stamp(checkpoint, before, 0), size_, previous_);
    const v1::InterfaceLoad& load = checkpoint.load();
    *message.mutable_load() = load;
    decode(message, checkpoint_stamp(checkpoint, load.time(), load.length()), size_, load_);
    work_of_loads_ = checkpoint.work_of_loads();
    exchanged_work_ = checkpoint.exchanged_work();
}

} // namespace duet::protocol
