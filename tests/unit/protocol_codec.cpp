// Interface data to messages and back, and everything that must be refused, without sockets.

#include "protocol/interface_codec.hpp"
#include "protocol/version.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace duet::protocol {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

const Stamp stamp{99, false, {7, 0.7, 0.1}};
const InterfaceSize size{3, 3};

InterfaceMotion motion() {
    return {0.7 + 0.1, {0, 0, 1, 0, 0.5, 1}, {1, 2, 3, 4, 5, 6}, {300, 301, 302}};
}

InterfaceLoad load() {
    return {0.7, 0.1, {1, -1, 2, -2, 3, -3}, {10, 20, 30}, 0.6, -0.6, 6};
}

std::vector<Chain> triangle() {
    return {{{0, 1, 2}, true, false, "wing"}};
}

v1::ToPeer motion_message() {
    v1::ToPeer message;
    encode(stamp, size, motion(), message);
    return message;
}

v1::ToPeer load_message() {
    v1::ToPeer message;
    encode(stamp, size, load(), message);
    return message;
}

/// The sentence and code of the Error that `function` throws.
template <typename Function>
std::pair<v1::Failed::Code, std::string> error_of(Function function) {
    try {
        function();
    } catch (const Error& error) {
        return {error.code(), error.what()};
    }
    return {v1::Failed::UNSPECIFIED, "nothing was thrown"};
}

/// `change` made to a good message must be refused by its receiver, with all of `words` said.
template <typename Change>
void expect_refused(v1::ToPeer message, Change change, const std::vector<std::string>& words) {
    const bool is_motion = message.has_motion();
    change(message);
    const auto [code, sentence] = error_of([&] {
        InterfaceMotion received_motion;
        InterfaceLoad received_load;
        if (is_motion)
            decode(message, stamp, size, received_motion);
        else
            decode(message, stamp, size, received_load);
    });
    EXPECT_EQ(code, v1::Failed::PEER) << sentence;
    for (const std::string& word : words)
        EXPECT_NE(sentence.find(word), std::string::npos) << word << " is not in: " << sentence;
}

void overwrite(std::string& bytes, std::size_t entry, double value) {
    bytes.replace(entry * sizeof value, sizeof value, reinterpret_cast<const char*>(&value), 8);
}

TEST(InterfaceCodec, MotionArrivesAsItLeft) {
    InterfaceMotion received;
    decode(motion_message(), stamp, size, received);
    EXPECT_EQ(received.time, 0.7 + 0.1);
    EXPECT_EQ(received.position, motion().position);
    EXPECT_EQ(received.velocity, motion().velocity);
    EXPECT_EQ(received.temperature, motion().temperature);
}

TEST(InterfaceCodec, LoadArrivesAsItLeft) {
    InterfaceLoad received;
    decode(load_message(), stamp, size, received);
    EXPECT_EQ(received.time, 0.7);
    EXPECT_EQ(received.length, 0.1);
    EXPECT_EQ(received.force, load().force);
    EXPECT_EQ(received.heat_flow, load().heat_flow);
    EXPECT_EQ(received.impulse_x, 0.6);
    EXPECT_EQ(received.impulse_y, -0.6);
    EXPECT_EQ(received.heat, 6);
}

TEST(InterfaceCodec, StartCarriesTheChains) {
    const Stamp at_start{99, true, {}};
    v1::ToPeer message;
    EXPECT_EQ(encode_start(at_start, triangle(), motion(), message).segments, 3U);
    std::vector<Chain> chains;
    InterfaceMotion received;
    const InterfaceSize got = decode_start(message, at_start, chains, received);
    EXPECT_EQ(got.nodes, 3U);
    EXPECT_EQ(got.segments, 3U);
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_EQ(chains[0].nodes, triangle()[0].nodes);
    EXPECT_TRUE(chains[0].closed);
    EXPECT_EQ(chains[0].name, "wing");
    EXPECT_EQ(received.time, 0);
}

TEST(InterfaceCodec, RefusesWhatIsOutOfTurn) {
    const auto set_run = [](v1::ToPeer& m) { m.mutable_motion()->set_run_id(98); };
    expect_refused(motion_message(), set_run, {"solid", "window 7", "run 98", "run 99"});
    const auto set_window = [](v1::ToPeer& m) { m.mutable_load()->set_window(6); };
    expect_refused(load_message(), set_window, {"fluid", "out of turn", "window 6"});
    const auto iterate = [](v1::ToPeer& m) { m.mutable_load()->set_iteration(1); };
    expect_refused(load_message(), iterate, {"fluid", "out of turn", "iteration 1"});
    const auto set_time = [](v1::ToPeer& m) { m.mutable_motion()->set_time(0.9); };
    expect_refused(motion_message(), set_time, {"solid", "0.9"});
    const auto set_length = [](v1::ToPeer& m) { m.mutable_load()->set_length(0.2); };
    expect_refused(load_message(), set_length, {"fluid", "0.2"});
    const auto mark_start = [](v1::ToPeer& m) { m.mutable_motion()->set_start(true); };
    expect_refused(motion_message(), mark_start, {"solid", "start"});
    const auto other_kind = [](v1::ToPeer& m) { *m.mutable_load() = load_message().load(); };
    expect_refused(motion_message(), other_kind, {"solid", "another kind"});
    const auto nothing = [](v1::ToPeer& m) { m.Clear(); };
    expect_refused(load_message(), nothing, {"fluid", "another kind"});
}

TEST(InterfaceCodec, RefusesWrongLengths) {
    const auto shorten = [](v1::ToPeer& m) { m.mutable_motion()->mutable_velocity()->pop_back(); };
    expect_refused(motion_message(), shorten, {"solid", "velocity", "47", "48"});
    const auto lengthen = [](v1::ToPeer& m) {
        m.mutable_load()->mutable_heat_flow()->append(8, '\0');
    };
    expect_refused(load_message(), lengthen, {"fluid", "heat_flow", "32", "24"});
    const auto empty = [](v1::ToPeer& m) { m.mutable_load()->clear_force(); };
    expect_refused(load_message(), empty, {"fluid", "force", "0 bytes"});
}

TEST(InterfaceCodec, RefusesNumbersThatAreNotFinite) {
    for (const double bad : {nan, infinity, -infinity}) {
        const auto position = [&](v1::ToPeer& m) {
            overwrite(*m.mutable_motion()->mutable_position(), 3, bad);
        };
        expect_refused(motion_message(), position, {"solid", "position[1].y", "window 7"});
        const auto temperature = [&](v1::ToPeer& m) {
            overwrite(*m.mutable_motion()->mutable_temperature(), 2, bad);
        };
        expect_refused(motion_message(), temperature, {"solid", "temperature[2]"});
        const auto heat_flow = [&](v1::ToPeer& m) {
            overwrite(*m.mutable_load()->mutable_heat_flow(), 0, bad);
        };
        expect_refused(load_message(), heat_flow, {"fluid", "heat_flow[0]"});
        const auto total = [&](v1::ToPeer& m) { m.mutable_load()->set_impulse_y(bad); };
        expect_refused(load_message(), total, {"fluid", "impulse_y"});
        const auto time = [&](v1::ToPeer& m) { m.mutable_load()->set_time(bad); };
        expect_refused(load_message(), time, {"fluid"});
    }
}

TEST(InterfaceCodec, PassesOnThatThePeerFailed) {
    const auto fail = [](v1::ToPeer& m) { m.mutable_failed()->set_text("Out of paper."); };
    expect_refused(load_message(), fail, {"fluid failed", "Out of paper."});
}

TEST(InterfaceCodec, NumbersThatDivergedDoNotLeaveTheirSolver) {
    v1::ToPeer message;
    InterfaceMotion bad_motion = motion();
    bad_motion.velocity[4] = nan;
    auto [code, sentence] = error_of([&] { encode(stamp, size, bad_motion, message); });
    EXPECT_EQ(code, v1::Failed::DIVERGED);
    EXPECT_NE(sentence.find("velocity[2].x"), std::string::npos) << sentence;
    InterfaceLoad bad_load = load();
    bad_load.heat = infinity;
    EXPECT_EQ(error_of([&] { encode(stamp, size, bad_load, message); }).first,
              v1::Failed::DIVERGED);
}

TEST(InterfaceCodec, ArraysOfTheWrongSizeDoNotLeaveTheirSolver) {
    v1::ToPeer message;
    InterfaceLoad bad_load = load();
    bad_load.force.pop_back();
    const auto [code, sentence] = error_of([&] { encode(stamp, size, bad_load, message); });
    EXPECT_EQ(code, v1::Failed::INTERNAL);
    EXPECT_NE(sentence.find("force holds 5 numbers where 6"), std::string::npos) << sentence;
}

TEST(InterfaceCodec, RefusesChainsThatAreNone) {
    const Stamp at_start{99, true, {}};
    const std::vector<std::pair<std::vector<Chain>, const char*>> cases{
        {{{{0, 1, 3}, true}}, "names node 3 of 3"},
        {{{{0, 1, 1}, true}}, "node 1 a second time"},
        {{{{0, 1}, false}}, "1 nodes belong to no chain"},
        {{{{0, 1}, true}}, "has 2 nodes and needs 3"},
        {{{{0, 1}, false}, {{2}, false}}, "chain[1] has 1 nodes and needs 2"},
    };
    for (const auto& [chains, words] : cases) {
        v1::ToPeer message;
        const auto own = error_of([&] { encode_start(at_start, chains, motion(), message); });
        EXPECT_EQ(own.first, v1::Failed::INTERNAL) << own.second;
        EXPECT_NE(own.second.find(words), std::string::npos) << own.second;

        encode_start(at_start, triangle(), motion(), message);
        message.mutable_motion()->clear_chain();
        for (const Chain& chain : chains) {
            v1::Chain& to = *message.mutable_motion()->add_chain();
            to.mutable_node()->Assign(chain.nodes.begin(), chain.nodes.end());
            to.set_closed(chain.closed);
        }
        std::vector<Chain> received;
        InterfaceMotion start;
        const auto theirs = error_of([&] { decode_start(message, at_start, received, start); });
        EXPECT_EQ(theirs.first, v1::Failed::PEER) << theirs.second;
        EXPECT_NE(theirs.second.find(words), std::string::npos) << theirs.second;
    }
}

TEST(InterfaceCodec, AnEmptyInterfaceIsOne) {
    const Stamp at_start{99, true, {}};
    v1::ToPeer message;
    EXPECT_EQ(encode_start(at_start, {}, {}, message).nodes, 0U);
    std::vector<Chain> chains;
    InterfaceMotion start;
    EXPECT_EQ(decode_start(message, at_start, chains, start).segments, 0U);
}

TEST(FirstNotFinite, FindsOnlyWhatIsNotFinite) {
    const double largest = std::numeric_limits<double>::max();
    const double smallest = std::numeric_limits<double>::denorm_min();
    const std::vector<double> fine{0.0, -0.0, largest, -largest, smallest, -smallest};
    EXPECT_EQ(first_not_finite(fine), fine.size());
    for (std::size_t i = 0; i < fine.size(); ++i)
        for (const double value : {nan, -nan, infinity, -infinity}) {
            std::vector<double> bad = fine;
            bad[i] = value;
            EXPECT_EQ(first_not_finite(bad), i);
        }
}

TEST(CheckReport, NamesTheFigure) {
    const auto refused = [](auto fill) {
        v1::Report report;
        fill(report);
        return error_of([&] { check_report(report, stamp.window); });
    };
    EXPECT_EQ(refused([](v1::Report&) {}).first, v1::Failed::UNSPECIFIED);
    const auto ledger = refused([](v1::Report& r) { r.mutable_ledger()->set_work(nan); });
    EXPECT_EQ(ledger.first, v1::Failed::DIVERGED);
    EXPECT_NE(ledger.second.find("work"), std::string::npos) << ledger.second;
    const auto figure =
        refused([](v1::Report& r) { (*r.mutable_ledger()->mutable_figure())["closure"] = nan; });
    EXPECT_NE(figure.second.find("closure"), std::string::npos) << figure.second;
    const auto probe = refused([](v1::Report& r) {
        v1::Sample& sample = *r.add_sample();
        sample.set_probe("centre");
        sample.add_value(infinity);
    });
    EXPECT_NE(probe.second.find("centre"), std::string::npos) << probe.second;
}

TEST(Version, SentenceNamesBothAndWhoMustUpgrade) {
    v1::Version one, two;
    one.set_major(1);
    one.set_minor(3);
    two.set_major(2);
    EXPECT_FALSE(compatible(one, two));
    v1::Version one_later = one;
    one_later.set_minor(9);
    EXPECT_TRUE(compatible(one, one_later));
    const std::string theirs_old = incompatibility("duet", two, "duet-fluid", one);
    EXPECT_NE(theirs_old.find("duet-fluid speaks protocol 1.3, duet speaks 2.0"), std::string::npos)
        << theirs_old;
    EXPECT_NE(theirs_old.find("upgrade duet-fluid."), std::string::npos) << theirs_old;
    const std::string ours_old = incompatibility("duet", one, "duet-fluid", two);
    EXPECT_NE(ours_old.find("upgrade duet."), std::string::npos) << ours_old;
}

} // namespace
} // namespace duet::protocol
