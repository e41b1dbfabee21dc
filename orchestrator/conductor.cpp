#include "orchestrator/conductor.hpp"

#include "orchestrator/schema.hpp"

#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace duet::orchestrator {

namespace {

using protocol::Event;
using std::chrono::duration;
using std::chrono::milliseconds;

constexpr auto tick = milliseconds(100);
constexpr std::uint32_t lease_windows = 4;
constexpr std::size_t leases_out = 2;

/// The smaller of two steps, of which 0 means no limit.
double smaller_step(double a, double b) {
    return a == 0 ? b : b == 0 ? a : std::min(a, b);
}

/// Whether `failure` only says what its solver was told by the one that `origin` names.
bool repeats(const Failure& failure, const Failure& origin) {
    return failure.sentence().starts_with("T" + origin.who().substr(1) + " failed");
}

Conductor::Clock::duration seconds(double s) {
    return std::chrono::duration_cast<Conductor::Clock::duration>(duration<double>(s));
}

} // namespace

Conductor::Conductor(Score score,
                     protocol::Session& session,
                     std::vector<Player>& players,
                     Recorder& recorder,
                     Audit& audit,
                     Progress& progress,
                     spdlog::logger& log)
    : score_(std::move(score)), session_(session), players_(players), recorder_(recorder),
      audit_(audit), progress_(progress), log_(log), calendar_(score_.configure.scene()) {
    session_.watch(score_.signals);
    for (const Player& player : players_)
        if (player.process) {
            session_.watch(player.process->pidfd());
            session_.watch(player.process->output());
        }
}

bool Conductor::play() {
    try {
        gather();
        while (!played_out()) {
            lend_time();
            attend_next();
            close_windows();
        }
        dismiss();
    } catch (const Failure& first) {
        throw root_cause(first);
    }
    return calendar_.done();
}

// ------------------------------------------------------------------------------ the phases of a
// run

/// Hello -> Configure -> Ready of every solver; then the books and the probes at the start.
void Conductor::gather() {
    const Clock::time_point deadline = Clock::now() + seconds(score_.connect_timeout);
    while (!all([](const Player& player) { return player.ready; })) {
        attend_next();
        for (const Player& player : players_)
            if (player.solver.empty() && player.process && Clock::now() > deadline)
                throw Failure(name_of(player),
                              player.now(),
                              "has not connected within " + number_text(score_.connect_timeout)
                                  + " s; is it a solver that takes --connect?");
    }
    gathering_ = false;
    Player* solid = player_of(v1::ROLE_SOLID);
    Player* fluid = player_of(v1::ROLE_FLUID);
    if (solid && fluid && solid->model.nodes() == 0)
        throw Failure(name_of(*solid),
                      solid->now(),
                      "and the fluid do not touch: no boundary of a body lies inside the fluid's "
                      "region; move the bodies, or leave one of the two out of the case");
    audit_.start(solid ? &solid->ledger : nullptr, fluid ? &fluid->ledger : nullptr);
    std::vector<v1::Sample> samples;
    for (const Player& player : players_)
        samples.insert(samples.end(), player.model.sample().begin(), player.model.sample().end());
    if (!samples.empty())
        recorder_.record(0, samples);
}

/// Two leases are out at any time, so that nobody waits for the conductor when one is used up. The
/// length of a lease's windows follows from what was reported at the end of the last but one before
/// it, never from how fast the solvers happen to run: a run has the same windows every time.
void Conductor::lend_time() {
    while (!stopping_ && !calendar_.done() && lease_ends_.size() < leases_out) {
        v1::ToSolver message;
        *message.mutable_lease() = calendar_.next(stable_step_, lease_windows);
        for (const Player& player : players_)
            session_.send(player.role, message); // one that is gone is noticed by its event
        lease_ends_.push_back(message.lease().first() + message.lease().count());
    }
}

/// Every window that all have reported: audit, probes, progress.
void Conductor::close_windows() {
    while (all([](const Player& player) { return !player.reports.empty(); }))
        close_window();
}

void Conductor::close_window() {
    const v1::Ledger* solid = nullptr;
    const v1::Ledger* fluid = nullptr;
    std::vector<v1::Sample> samples;
    time_ = players_.front().reports.front().time();
    for (Player& player : players_) {
        const v1::Report& report = player.reports.front();
        (player.role == v1::ROLE_SOLID ? solid : fluid) = &report.ledger();
        samples.insert(samples.end(), report.sample().begin(), report.sample().end());
    }
    if (const auto broken = audit_.window(solid, fluid))
        throw Failure("the audit", {closed_, time_}, *broken);
    if (!samples.empty()) {
        recorder_.record(time_, samples);
        log_.info("t = {} s, window {}: recorded", time_, closed_);
    }
    ++closed_;
    if (closed_ == lease_ends_.front()) {
        lease_ends_.pop_front();
        stable_step_ = 0;
        for (const Player& player : players_)
            stable_step_ = smaller_step(stable_step_, player.reports.front().stable_step());
    }
    for (Player& player : players_)
        player.reports.pop_front();
    progress_.reached(time_);
}

/// Finish -> Bye -> exit of every solver.
void Conductor::dismiss() {
    v1::ToSolver finish;
    finish.mutable_finish();
    for (const Player& player : players_)
        session_.send(player.role, finish);
    while (!all([](const Player& player) { return player.bye; }))
        attend_next();
    const Clock::time_point deadline = Clock::now() + std::chrono::seconds(5);
    for (Player& player : players_) {
        if (!player.process)
            continue;
        session_.unwatch(player.process->pidfd());
        session_.unwatch(player.process->output());
        player.ending = player.process->wait_until(deadline);
        if (!player.ending)
            throw Failure(name_of(player), player.now(), "said goodbye, but does not end");
        if (!player.ending->good)
            throw Failure(name_of(player), player.now(), player.ending->text + " after the run");
    }
    // The last copies of exchanges may still be under way.
    const Clock::time_point last = Clock::now() + milliseconds(500);
    while (score_.configure.record() && Clock::now() < last) {
        const auto event = session_.next(Clock::now() + milliseconds(50));
        if (!event)
            break;
        attend(*event);
    }
}

bool Conductor::played_out() const {
    return (calendar_.done() || stopping_) && lease_ends_.empty();
}

// -------------------------------------------------------------------------------------------
// events

void Conductor::attend_next() {
    if (auto event = session_.next(Clock::now() + tick))
        attend(std::move(*event));
    else
        check_silence(); // only when nothing is left unread
    if (stopping_ && Clock::now() > stop_deadline_)
        throw Interrupted();
}

void Conductor::attend(Event event) {
    Player* player = player_of(event.role);
    switch (event.kind) {
    case Event::Kind::message:
        return attend_message(*player, event.message);
    case Event::Kind::exchange:
        return recorder_.record(event.exchange);
    case Event::Kind::descriptor:
        return attend_descriptor(event.descriptor);
    case Event::Kind::refused:
        throw Failure(
            player ? name_of(*player) : "a solver", player ? player->now() : When{}, event.text);
    case Event::Kind::garbage:
        log_.warn("{}", event.text);
        // A stranger cannot disturb a run; but before all have connected, it is one of ours.
        if (player || gathering_)
            throw Failure(player ? name_of(*player) : "a solver",
                          player ? player->now() : When{},
                          event.text);
        return;
    case Event::Kind::disconnected:
        if (player && !player->bye && !player->failed) {
            player->gone = true;
            throw Failure(name_of(*player), player->now(), event.text, !player->process);
        }
        return;
    }
}

void Conductor::attend_message(Player& player, const v1::ToOrchestrator& message) {
    switch (message.message_case()) {
    case v1::ToOrchestrator::kHello:
        return greet(player, message.hello());
    case v1::ToOrchestrator::kReady:
        player.ready = true;
        player.model = message.ready();
        player.ledger = player.model.ledger();
        stable_step_ = smaller_step(stable_step_, player.model.stable_step());
        for (const std::string& line : player.model.model())
            log_.info("{} models: {}", name_of(player), line);
        log_.info("{} is ready: {} unknowns, {} interface nodes, stable step {} s",
                  name_of(player),
                  player.model.unknowns(),
                  player.model.nodes(),
                  player.model.stable_step());
        return;
    case v1::ToOrchestrator::kReport: {
        const v1::Report& report = message.report();
        player.reports.push_back(report);
        player.ledger = report.ledger();
        player.timing.MergeFrom(report.timing()); // phases come with samples only
        player.steps += report.steps();
        player.windows = report.window() + 1;
        player.time = report.time();
        return;
    }
    case v1::ToOrchestrator::kBye:
        player.bye = true;
        player.timing.MergeFrom(message.bye().timing());
        return;
    case v1::ToOrchestrator::kFailed: {
        player.failed = true;
        const v1::Failed& failed = message.failed();
        When when = player.now();
        if (failed.window() > 0 || failed.time() > 0)
            when = {failed.window(), failed.time()};
        throw Failure(name_of(player), when, failed.text(), failed.code() != v1::Failed::PEER);
    }
    case v1::ToOrchestrator::kHeartbeat:
        player.phase = message.heartbeat().phase();
        return;
    default:
        return; // checkpoints are not asked for
    }
}

void Conductor::greet(Player& player, const v1::Hello& hello) {
    player.solver = hello.solver();
    log_.info("{} is {}, process {}", name_of(player), hello.solver(), hello.process_id());
    v1::ToSolver message;
    v1::Configure& configure = *message.mutable_configure();
    configure = score_.configure;
    configure.set_role(player.role);
    configure.set_threads(player.threads);
    configure.set_peer_bind(player.role == v1::ROLE_SOLID);
    session_.send(player.role, message);
}

void Conductor::attend_descriptor(int descriptor) {
    if (descriptor == score_.signals)
        return attend_signal();
    for (Player& player : players_) {
        if (!player.process)
            continue;
        if (descriptor == player.process->output()) {
            player.process->read_output();
            if (player.process->output() < 0)
                session_.unwatch(descriptor);
        } else if (descriptor == player.process->pidfd()) {
            session_.unwatch(player.process->pidfd());
            session_.unwatch(player.process->output());
            process_ended(player);
        }
    }
}

void Conductor::attend_signal() {
    signalfd_siginfo info{};
    if (::read(score_.signals, &info, sizeof info) != sizeof info)
        return;
    log_.warn("asked to stop by signal {}", info.ssi_signo);
    if (gathering_ || stopping_)
        throw Interrupted();
    stopping_ = true;
    stop_deadline_ = Clock::now() + std::chrono::seconds(10);
    progress_.say(
        "stopping at the end of the window, in 10 s at the latest; once more to stop at once");
}

/// Its end is news unless it has taken its leave, or has said itself what went wrong.
void Conductor::process_ended(Player& player) {
    player.ending = player.process->poll();
    std::optional<Failure> word; // the other side's, about this end: the end itself says more
    try {
        if (player.ending)
            read_last_words(player);
    } catch (const Failure& other) {
        if (other.direct())
            throw;
        word = other;
    }
    if (!player.ending || player.failed || (player.bye && player.ending->good)) {
        if (word)
            throw *word;
        return;
    }
    std::string what = player.ending->text;
    if (player.solver.empty())
        what += " before it connected";
    if (!player.last_words.empty())
        what += "; it last printed: " + player.last_words;
    throw Failure(name_of(player), player.now(), what);
}

/// An end may overtake the last words on the socket, its Bye or its Failed: reads on to them.
void Conductor::read_last_words(const Player& player) {
    const Clock::time_point deadline = Clock::now() + std::chrono::seconds(1);
    while (!player.solver.empty() && !player.gone && !player.bye && !player.failed) {
        auto event = session_.next(deadline);
        if (!event || (event->kind == Event::Kind::disconnected && event->role == player.role))
            return;
        attend(std::move(*event));
    }
}

void Conductor::check_silence() {
    for (const Player& player : players_) {
        if (!player.process || player.solver.empty() || player.bye)
            continue; // started by hand, it may stand in a debugger
        const double silent =
            duration<double>(Clock::now() - session_.last_heard(player.role)).count();
        if (silent > score_.silence)
            throw Failure(name_of(player),
                          player.now(),
                          "has given no sign of life for " + number_text(std::floor(silent))
                              + " s; its process " + std::to_string(player.process->id()) + " is "
                              + player.process->state()
                              + (player.phase.empty() ? "" : ", its last phase: " + player.phase));
    }
}

/// One side's word about the other waits a moment for the other's own: the death of its process,
/// or what it says itself.
Failure Conductor::root_cause(const Failure& first) {
    if (first.direct())
        return first;
    const Clock::time_point deadline = Clock::now() + std::chrono::seconds(1);
    while (auto event = session_.next(deadline)) {
        try {
            attend(std::move(*event));
        } catch (const Failure& other) {
            if (repeats(first, other))
                return other;
            if (!other.direct())
                continue;
            if (other.who() == first.who())
                return other;
            return Failure(other.who(),
                           other.when(),
                           other.sentence() + "; " + first.who() + " says: " + first.sentence());
        }
    }
    return first;
}

void Conductor::abort(const std::string& why) {
    v1::ToSolver message;
    message.mutable_abort()->set_text(why);
    for (const Player& player : players_)
        session_.send(player.role, message);
    const Clock::time_point deadline = Clock::now() + std::chrono::seconds(1);
    for (Player& player : players_)
        if (player.process && !(player.ending = player.process->wait_until(deadline))) {
            log_.warn("{} does not end by itself and is killed", name_of(player));
            player.process->kill();
            player.ending = player.process->wait_until(Clock::now() + std::chrono::seconds(2));
        }
}

Player* Conductor::player_of(v1::Role role) {
    for (Player& player : players_)
        if (player.role == role)
            return &player;
    return nullptr;
}

bool Conductor::all(bool (*condition)(const Player&)) const {
    return std::all_of(players_.begin(), players_.end(), condition);
}

} // namespace duet::orchestrator
