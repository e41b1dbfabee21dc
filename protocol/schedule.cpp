#include "protocol/schedule.hpp"

#include "protocol/solver.hpp"

#include <algorithm>
#include <iterator>
#include <string>

namespace duet::protocol {

namespace {

struct Row {
    v1::Coupling::Schedule schedule;
    std::array<Act, 3> solid;
    std::array<Act, 3> fluid;
};

using enum Act;

constexpr Row table[] = {
    {v1::Coupling::FLUID_FIRST, {receive, advance, send}, {advance, send, receive}},
    {v1::Coupling::SOLID_FIRST, {advance, send, receive}, {receive, advance, send}},
    {v1::Coupling::PARALLEL, {advance, send, receive}, {advance, send, receive}},
};

} // namespace

const std::array<Act, 3>& acts(v1::Coupling::Schedule schedule, v1::Role role) {
    const auto row = std::find_if(
        std::begin(table), std::end(table), [&](const Row& r) { return r.schedule == schedule; });
    if (row == std::end(table))
        throw Error(v1::Failed::SCENE,
                    "The schedule with number " + std::to_string(schedule)
                        + " is unknown here; upgrade this solver.");
    return role == v1::ROLE_SOLID ? row->solid : row->fluid;
}

bool end_is_known(v1::Coupling::Schedule schedule) {
    return acts(schedule, v1::ROLE_FLUID).front() == receive;
}

Turn::Turn(v1::Coupling::Schedule schedule, v1::Role role, bool peer) {
    for (const Act act : acts(schedule, role))
        if (peer || act == advance)
            acts_[count_++] = act;
    position_ = count_;
}

std::optional<Act> Turn::due() const {
    if (position_ == count_)
        return std::nullopt;
    return acts_[position_];
}

void Turn::begin(std::uint64_t window) {
    if (due())
        throw Error(v1::Failed::INTERNAL,
                    "Window " + std::to_string(window) + " was begun before window "
                        + std::to_string(next_window_ - 1) + " ended.");
    if (window != next_window_)
        throw Error(v1::Failed::PEER,
                    "The orchestrator leased window " + std::to_string(window) + " where window "
                        + std::to_string(next_window_) + " is due.");
    ++next_window_;
    position_ = 0;
}

void Turn::done() {
    if (!due())
        throw Error(v1::Failed::INTERNAL, "No act is due between windows.");
    ++position_;
}

void Turn::resume(std::uint64_t next_window) {
    if (due())
        throw Error(v1::Failed::INTERNAL, "A window can only be left at its end.");
    next_window_ = next_window;
}

} // namespace duet::protocol
