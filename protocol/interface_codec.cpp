#include "protocol/interface_codec.hpp"

#include "protocol/version.hpp"

#include <bit>
#include <cmath>
#include <cstring>

namespace duet::protocol {

static_assert(std::endian::native == std::endian::little,
              "arrays travel as little-endian float64 and are copied as they are");

namespace {

/// Whose data are looked at, and which: the first half of every sentence.
struct Subject {
    v1::Role sender;
    const Stamp& stamp;
    bool own;

    std::string text() const {
        const std::string what = sender == v1::ROLE_FLUID ? "load" : "motion";
        const std::string when =
            stamp.start ? " at the start" : " of window " + std::to_string(stamp.window.index);
        return "The " + name_of(sender) + "'s " + what + when;
    }

    [[noreturn]] void refuse(const std::string& what) const {
        if (own)
            throw Error(v1::Failed::INTERNAL, text() + ": " + what + "; this solver must mend it.");
        throw Error(v1::Failed::PEER,
                    text() + ": " + what + "; the " + name_of(sender)
                        + " broke the protocol and must mend it.");
    }

    [[noreturn]] void refuse_number(const std::string& field, double value) const {
        const std::string what =
            text() + ": " + field + " is " + std::to_string(value) + ", not a finite number; ";
        if (own)
            throw Error(v1::Failed::DIVERGED,
                        what + "the solution diverged: shorten the window or refine.");
        throw Error(v1::Failed::PEER,
                    what + "the " + name_of(sender) + " must not send it: see its output.");
    }
};

std::string entry_name(const char* field, std::size_t entry, std::size_t components) {
    std::string name = std::string(field) + "[" + std::to_string(entry / components) + "]";
    if (components == 2)
        name += entry % 2 == 0 ? ".x" : ".y";
    return name;
}

void check_array(const Subject& subject,
                 const char* field,
                 std::span<const double> values,
                 std::size_t entries,
                 std::size_t components) {
    if (values.size() != entries * components)
        subject.refuse(std::string(field) + " holds " + std::to_string(values.size())
                       + " numbers where " + std::to_string(entries * components) + " are due");
    const std::size_t bad = first_not_finite(values);
    if (bad != values.size())
        subject.refuse_number(entry_name(field, bad, components), values[bad]);
}

void put(std::span<const double> values, std::string& bytes) {
    bytes.assign(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

void take(const Subject& subject,
          const char* field,
          const std::string& bytes,
          std::size_t entries,
          std::size_t components,
          std::vector<double>& values) {
    const std::size_t due = entries * components * sizeof(double);
    if (bytes.size() != due)
        subject.refuse(std::string(field) + " holds " + std::to_string(bytes.size())
                       + " bytes where " + std::to_string(due) + " are due");
    values.resize(entries * components);
    if (due != 0)
        std::memcpy(values.data(), bytes.data(), due);
    check_array(subject, field, values, entries, components);
}

void check_scalar(const Subject& subject, const char* field, double value) {
    if (!std::isfinite(value))
        subject.refuse_number(field, value);
}

/// A negative one would ask the solid to feed its vibrations.
void check_impedance(const Subject& subject, double value) {
    check_scalar(subject, "impedance", value);
    if (value < 0)
        subject.refuse("impedance is " + std::to_string(value)
                       + " Pa s/m where no negative number can stand");
}

/// Every node belongs to one place of one chain.
InterfaceSize
check_chains(const Subject& subject, const std::vector<Chain>& chains, std::size_t nodes) {
    std::vector<bool> seen(nodes, false);
    InterfaceSize size{nodes, 0};
    std::size_t named = 0;
    for (std::size_t c = 0; c < chains.size(); ++c) {
        const std::string name = "chain[" + std::to_string(c) + "]";
        const std::size_t least = chains[c].closed ? 3 : 2;
        if (chains[c].nodes.size() < least)
            subject.refuse(name + " has " + std::to_string(chains[c].nodes.size())
                           + " nodes and needs " + std::to_string(least));
        for (const std::uint32_t node : chains[c].nodes) {
            if (node >= nodes)
                subject.refuse(name + " names node " + std::to_string(node) + " of "
                               + std::to_string(nodes));
            if (seen[node])
                subject.refuse(name + " names node " + std::to_string(node) + " a second time");
            seen[node] = true;
        }
        named += chains[c].nodes.size();
        size.segments += chains[c].segments();
    }
    if (named != nodes)
        subject.refuse(std::to_string(nodes - named) + " nodes belong to no chain");
    return size;
}

double motion_time(const Stamp& stamp) {
    return stamp.start ? stamp.window.time : stamp.window.time + stamp.window.length;
}

void check_motion(const Subject& subject, std::size_t nodes, const InterfaceMotion& motion) {
    check_array(subject, "position", motion.position, nodes, 2);
    check_array(subject, "velocity", motion.velocity, nodes, 2);
    check_array(subject, "temperature", motion.temperature, nodes, 1);
}

void put_motion(const Stamp& stamp, const InterfaceMotion& motion, v1::InterfaceMotion& out) {
    out.set_run_id(stamp.run_id);
    out.set_window(stamp.window.index);
    out.set_iteration(0);
    out.set_time(motion_time(stamp));
    out.set_start(stamp.start);
    put(motion.position, *out.mutable_position());
    put(motion.velocity, *out.mutable_velocity());
    put(motion.temperature, *out.mutable_temperature());
}

/// The message of the right kind, or an Error that tells what came instead.
template <typename Message>
const Message&
expect(const Subject& subject, const v1::ToPeer& message, bool right_kind, const Message& content) {
    if (message.has_failed())
        throw Error(v1::Failed::PEER,
                    "The " + name_of(subject.sender) + " failed: " + message.failed().text());
    if (!right_kind)
        subject.refuse("a message of another kind came in its turn");
    if (content.run_id() != subject.stamp.run_id)
        subject.refuse("it belongs to run " + std::to_string(content.run_id()) + ", this is run "
                       + std::to_string(subject.stamp.run_id));
    if (content.window() != subject.stamp.window.index || content.iteration() != 0)
        subject.refuse("out of turn: it is marked window " + std::to_string(content.window())
                       + ", iteration " + std::to_string(content.iteration()));
    return content;
}

/// Both sides work the times of windows out of the lease; a compiler that contracts products and
/// sums, or another language, may round the last bits otherwise.
bool same_time(double a, double b) {
    return std::abs(a - b) <= 1e-12 * std::abs(b);
}

void take_motion(const Subject& subject,
                 std::size_t nodes,
                 const v1::InterfaceMotion& in,
                 InterfaceMotion& motion) {
    if (in.start() != subject.stamp.start)
        subject.refuse(in.start() ? "out of turn: it is marked as the start"
                                  : "out of turn: it is not marked as the start");
    if (!same_time(in.time(), motion_time(subject.stamp)))
        subject.refuse("its time is " + std::to_string(in.time()) + " s where "
                       + std::to_string(motion_time(subject.stamp)) + " s is due");
    motion.time = in.time();
    take(subject, "position", in.position(), nodes, 2, motion.position);
    take(subject, "velocity", in.velocity(), nodes, 2, motion.velocity);
    take(subject, "temperature", in.temperature(), nodes, 1, motion.temperature);
}

} // namespace

std::size_t first_not_finite(std::span<const double> values) {
    // One branch-free pass over the exponents in the usual case: all ones means infinite or NaN.
    constexpr std::uint64_t exponent = 0x7ff0'0000'0000'0000;
    std::uint64_t bad = 0;
    for (const double value : values)
        bad |= static_cast<std::uint64_t>((std::bit_cast<std::uint64_t>(value) & exponent)
                                          == exponent);
    if (bad == 0)
        return values.size();
    std::size_t i = 0;
    while (std::isfinite(values[i]))
        ++i;
    return i;
}

InterfaceSize encode_start(const Stamp& stamp,
                           const std::vector<Chain>& chains,
                           const InterfaceMotion& start,
                           v1::ToPeer& message) {
    const Subject subject{v1::ROLE_SOLID, stamp, true};
    check_motion(subject, start.nodes(), start);
    const InterfaceSize size = check_chains(subject, chains, start.nodes());
    v1::InterfaceMotion& out = *message.mutable_motion();
    put_motion(stamp, start, out);
    out.clear_chain();
    for (const Chain& chain : chains) {
        v1::Chain& to = *out.add_chain();
        to.mutable_node()->Assign(chain.nodes.begin(), chain.nodes.end());
        to.set_closed(chain.closed);
        to.set_insulated(chain.insulated);
        to.set_name(chain.name);
    }
    return size;
}

InterfaceSize decode_start(const v1::ToPeer& message,
                           const Stamp& expected,
                           std::vector<Chain>& chains,
                           InterfaceMotion& start) {
    const Subject subject{v1::ROLE_SOLID, expected, false};
    const v1::InterfaceMotion& in =
        expect(subject, message, message.has_motion(), message.motion());
    take_motion(subject, in.temperature().size() / sizeof(double), in, start);
    chains.clear();
    for (const v1::Chain& chain : in.chain())
        chains.push_back({{chain.node().begin(), chain.node().end()},
                          chain.closed(),
                          chain.insulated(),
                          chain.name()});
    return check_chains(subject, chains, start.nodes());
}

void encode(const Stamp& stamp,
            const InterfaceSize& size,
            const InterfaceMotion& motion,
            v1::ToPeer& message) {
    check_motion({v1::ROLE_SOLID, stamp, true}, size.nodes, motion);
    put_motion(stamp, motion, *message.mutable_motion());
    message.mutable_motion()->clear_chain();
}

void decode(const v1::ToPeer& message,
            const Stamp& expected,
            const InterfaceSize& size,
            InterfaceMotion& motion) {
    const Subject subject{v1::ROLE_SOLID, expected, false};
    take_motion(subject,
                size.nodes,
                expect(subject, message, message.has_motion(), message.motion()),
                motion);
}

void encode(const Stamp& stamp,
            const InterfaceSize& size,
            const InterfaceLoad& load,
            v1::ToPeer& message) {
    const Subject subject{v1::ROLE_FLUID, stamp, true};
    check_array(subject, "force", load.force, size.nodes, 2);
    check_array(subject, "heat_flow", load.heat_flow, size.segments, 1);
    check_scalar(subject, "impulse_x", load.impulse_x);
    check_scalar(subject, "impulse_y", load.impulse_y);
    check_scalar(subject, "heat", load.heat);
    check_impedance(subject, load.impedance);
    v1::InterfaceLoad& out = *message.mutable_load();
    out.set_run_id(stamp.run_id);
    out.set_window(stamp.window.index);
    out.set_iteration(0);
    out.set_time(stamp.window.time);
    out.set_length(stamp.window.length);
    put(load.force, *out.mutable_force());
    put(load.heat_flow, *out.mutable_heat_flow());
    out.set_impulse_x(load.impulse_x);
    out.set_impulse_y(load.impulse_y);
    out.set_heat(load.heat);
    out.set_impedance(load.impedance);
}

void decode(const v1::ToPeer& message,
            const Stamp& expected,
            const InterfaceSize& size,
            InterfaceLoad& load) {
    const Subject subject{v1::ROLE_FLUID, expected, false};
    const v1::InterfaceLoad& in = expect(subject, message, message.has_load(), message.load());
    if (!same_time(in.time(), expected.window.time) || in.length() != expected.window.length)
        subject.refuse("it covers " + std::to_string(in.length()) + " s from "
                       + std::to_string(in.time()) + " s where "
                       + std::to_string(expected.window.length) + " s from "
                       + std::to_string(expected.window.time) + " s are due");
    load.time = in.time();
    load.length = in.length();
    take(subject, "force", in.force(), size.nodes, 2, load.force);
    take(subject, "heat_flow", in.heat_flow(), size.segments, 1, load.heat_flow);
    for (const auto& [field, value] : {std::pair{"impulse_x", in.impulse_x()},
                                       std::pair{"impulse_y", in.impulse_y()},
                                       std::pair{"heat", in.heat()}})
        check_scalar(subject, field, value);
    check_impedance(subject, in.impedance());
    load.impulse_x = in.impulse_x();
    load.impulse_y = in.impulse_y();
    load.heat = in.heat();
    load.impedance = in.impedance();
}

void check_report(const v1::Report& report, const Window& window) {
    const auto check = [&](const std::string& figure, double value) {
        if (!std::isfinite(value))
            throw Error(v1::Failed::DIVERGED,
                        "In the report of window " + std::to_string(window.index) + ", " + figure
                            + " is " + std::to_string(value)
                            + ", not a finite number; the solution diverged: shorten the window "
                              "or refine.");
    };
    check("stable_step", report.stable_step());
    const v1::Ledger& ledger = report.ledger();
    const google::protobuf::Descriptor& fields = *v1::Ledger::descriptor();
    for (int i = 0; i < fields.field_count(); ++i)
        if (fields.field(i)->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE)
            check(fields.field(i)->name(),
                  ledger.GetReflection()->GetDouble(ledger, fields.field(i)));
    for (const auto& [name, value] : ledger.figure())
        check("figure '" + name + "'", value);
    for (const v1::Sample& sample : report.sample())
        for (const double value : sample.value())
            check("probe '" + sample.probe() + "'", value);
}

} // namespace duet::protocol
