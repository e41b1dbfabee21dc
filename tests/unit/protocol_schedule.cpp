// The step order, without sockets: two sides follow the table, with queues in the place of the
// wire.

#include "protocol/schedule.hpp"
#include "protocol/solver.hpp"

#include <gtest/gtest.h>

#include <deque>

namespace duet::protocol {
namespace {

constexpr std::int64_t start = -1; // the motion before window 0, and no load yet
constexpr std::uint64_t windows = 5;

/// One side; what it exchanges is the number of the window that made it.
struct Player {
    Player(v1::Coupling::Schedule schedule, v1::Role role) : turn(schedule, role, true) {}

    Turn turn;
    std::deque<std::int64_t> inbox;
    std::deque<std::int64_t>* outbox = nullptr;
    std::int64_t held = start;
    std::vector<std::int64_t> advanced_with; // by window

    /// Does what is due; false if it has to wait for the other, or is done.
    bool step() {
        if (!turn.due() && turn.next_window() < windows)
            turn.begin(turn.next_window());
        const auto act = turn.due();
        if (!act || (*act == Act::receive && inbox.empty()))
            return false;
        const auto window = static_cast<std::int64_t>(turn.next_window()) - 1;
        if (*act == Act::advance)
            advanced_with.push_back(held);
        if (*act == Act::send)
            outbox->push_back(window);
        if (*act == Act::receive) {
            held = inbox.front();
            inbox.pop_front();
            EXPECT_EQ(held, window) << "a message is received in the window that it is marked with";
        }
        turn.done();
        return true;
    }
};

struct Expected {
    const char* name;
    v1::Coupling::Schedule schedule;
    std::int64_t load_lag;   // the solid advances window k under the load of window k - load_lag
    std::int64_t motion_lag; // the fluid in the motion of the end of window k - motion_lag
};

class Schedules : public testing::TestWithParam<Expected> {};

TEST_P(Schedules, EachSideAdvancesWithTheDataOfTheRightWindow) {
    Player solid(GetParam().schedule, v1::ROLE_SOLID);
    Player fluid(GetParam().schedule, v1::ROLE_FLUID);
    solid.outbox = &fluid.inbox;
    fluid.outbox = &solid.inbox;
    bool moved = true;
    while (moved) {
        moved = solid.step();
        moved = fluid.step() || moved;
    }
    ASSERT_EQ(solid.advanced_with.size(), windows) << "the two wait for each other";
    ASSERT_EQ(fluid.advanced_with.size(), windows) << "the two wait for each other";
    for (std::int64_t k = 0; k < static_cast<std::int64_t>(windows); ++k) {
        const auto i = static_cast<std::size_t>(k);
        EXPECT_EQ(solid.advanced_with[i], k - GetParam().load_lag);
        EXPECT_EQ(fluid.advanced_with[i], k - GetParam().motion_lag);
    }
    EXPECT_EQ(end_is_known(GetParam().schedule), GetParam().motion_lag == 0);
    // Nothing is left on the wire: a checkpoint between windows is complete.
    EXPECT_TRUE(solid.inbox.empty());
    EXPECT_TRUE(fluid.inbox.empty());
}

INSTANTIATE_TEST_SUITE_P(All,
                         Schedules,
                         testing::Values(Expected{"fluid_first", v1::Coupling::FLUID_FIRST, 0, 1},
                                         Expected{"solid_first", v1::Coupling::SOLID_FIRST, 1, 0},
                                         Expected{"parallel", v1::Coupling::PARALLEL, 1, 1}),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(Turn, WithoutAPeerOnlyAdvances) {
    Turn turn(v1::Coupling::FLUID_FIRST, v1::ROLE_FLUID, false);
    turn.begin(0);
    EXPECT_EQ(turn.due(), Act::advance);
    turn.done();
    EXPECT_EQ(turn.due(), std::nullopt);
}

TEST(Turn, RefusesWindowsOutOfOrder) {
    Turn turn(v1::Coupling::FLUID_FIRST, v1::ROLE_FLUID, false);
    EXPECT_THROW(turn.begin(1), Error);
    turn.begin(0);
    EXPECT_THROW(turn.begin(1), Error) << "window 0 has not ended";
    EXPECT_THROW(turn.resume(7), Error) << "window 0 has not ended";
    turn.done();
    EXPECT_THROW(turn.done(), Error) << "nothing is due";
    EXPECT_THROW(turn.begin(0), Error) << "window 0 is over";
    turn.resume(7);
    turn.begin(7);
    EXPECT_EQ(turn.next_window(), 8U);
}

TEST(Turn, RefusesAScheduleItDoesNotKnow) {
    EXPECT_THROW(Turn(static_cast<v1::Coupling::Schedule>(17), v1::ROLE_SOLID, true), Error);
}

} // namespace
} // namespace duet::protocol
