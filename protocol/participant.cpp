#include "protocol/participant.hpp"

#include "protocol/side.hpp"
#include "protocol/version.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <memory>
#include <sys/resource.h>
#include <unistd.h>

namespace duet::protocol {

namespace {

using Clock = ControlLink::Clock;

Clock::duration seconds(double value) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(value));
}

double since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// s, of all threads of this process
double cpu_time() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

/// Aside, then renamed: a checkpoint is whole or not there.
void write_file(const std::filesystem::path& path, const v1::Checkpoint& checkpoint) {
    std::filesystem::path aside = path;
    aside += ".part";
    std::ofstream file(aside, std::ios::binary | std::ios::trunc);
    if (!checkpoint.SerializeToOstream(&file) || !file.flush())
        throw Error(v1::Failed::INTERNAL,
                    "Cannot write the checkpoint '" + aside.string() + "' (" + std::strerror(errno)
                        + "); make room or choose another folder.");
    file.close();
    std::filesystem::rename(aside, path);
}

/// Serves one run on behalf of one side.
class Participant {
  public:
    Participant(zmq::context_t& context, Side& side, const Arguments& arguments)
        : context_(context), side_(side), arguments_(arguments),
          control_(context, arguments.connect) {}

    void serve() {
        greet();
        configure();
        while (!finished_)
            obey(next_order());
    }

    /// Tells both sides why this one ends.
    void fail(v1::Failed::Code code, const std::string& sentence) {
        v1::ToOrchestrator message;
        v1::Failed& failed = *message.mutable_failed();
        failed.set_code(code);
        failed.set_text(sentence);
        failed.set_window(window_.index);
        failed.set_time(window_.time);
        if (exchange_)
            exchange_->tell_failed(failed);
        control_.send(message);
    }

  private:
    void greet() {
        v1::ToOrchestrator message;
        v1::Hello& hello = *message.mutable_hello();
        *hello.mutable_version() = version();
        hello.set_role(side_.role());
        hello.set_solver(side_.solver().name());
        hello.add_capabilities("save");
        hello.set_process_id(getpid());
        control_.send(message);
    }

    void configure() {
        phase("waiting for the orchestrator");
        const auto answer = control_.receive(Clock::now() + seconds(arguments_.connect_timeout));
        if (!answer)
            throw Error(v1::Failed::PEER,
                        "No orchestrator answered at " + arguments_.connect + " within "
                            + std::to_string(arguments_.connect_timeout) + " s.");
        if (!answer->has_configure())
            out_of_turn("Configure");
        configure_ = answer->configure();
        check_configure();
        phase("configuring");
        start_ = Clock::now();
        control_.pulse().interval = configure_.heartbeat_interval();
        const bool peer = !configure_.peer_address().empty();
        if (peer)
            exchange_ = std::make_unique<Exchange>(context_, configure_, control_);
        turn_ = Turn(configure_.schedule(), side_.role(), peer);
        v1::ToOrchestrator message;
        side_.configure(configure_, exchange_.get(), *message.mutable_ready());
        control_.send(message);
    }

    void check_configure() const {
        if (!compatible(version(), configure_.version()))
            throw Error(
                v1::Failed::VERSION,
                incompatibility(
                    side_.solver().name(), version(), "The orchestrator", configure_.version()));
        if (configure_.role() != side_.role())
            throw Error(v1::Failed::PEER,
                        "The orchestrator takes this " + name_of(side_.role()) + " for a "
                            + name_of(configure_.role()) + ".");
        for (const double value : {configure_.timeout(), configure_.heartbeat_interval()})
            if (!(value > 0) || !std::isfinite(value))
                throw Error(v1::Failed::PEER,
                            "The orchestrator's Configure lacks a positive timeout or heartbeat "
                            "interval.");
    }

    v1::ToSolver next_order() {
        phase("waiting for the orchestrator");
        const auto before = Clock::now();
        auto order = control_.receive(before + seconds(configure_.timeout()));
        waiting_for_lease_ += since(before);
        if (!order)
            throw Error(v1::Failed::PEER,
                        "The orchestrator has sent nothing for "
                            + std::to_string(configure_.timeout())
                            + " s; it hangs or was stopped.");
        return *std::move(order);
    }

    void obey(const v1::ToSolver& order) {
        switch (order.message_case()) {
        case v1::ToSolver::kLease:
            return use(order.lease());
        case v1::ToSolver::kSave:
            return save(order.save());
        case v1::ToSolver::kRestore:
            return restore(order.restore());
        case v1::ToSolver::kFinish:
            return finish();
        default:
            out_of_turn("Lease, Save, Restore or Finish");
        }
    }

    void use(const v1::Lease& lease) {
        if (!(lease.length() > 0) || !std::isfinite(lease.length()) || !std::isfinite(lease.time()))
            throw Error(v1::Failed::PEER,
                        "The orchestrator leased windows of " + std::to_string(lease.length())
                            + " s from " + std::to_string(lease.time()) + " s.");
        for (std::uint32_t i = 0; i < lease.count(); ++i) {
            const bool last = i + 1 == lease.count();
            play({lease.first() + i,
                  lease.time() + i * lease.length(),
                  lease.length(),
                  last && lease.sample(),
                  last && lease.snapshot()});
        }
        control_.flush(); // the orchestrator may renew the lease on these reports
    }

    /// One window, in the order of the schedule.
    void play(const Window& window) {
        turn_.begin(window.index);
        window_ = window;
        control_.pulse().window = window.index;
        control_.pulse().time = window.time;
        v1::Report& report = *report_.mutable_report();
        report.Clear();
        const Act last_of_ours = exchange_ ? Act::send : Act::advance;
        while (const auto act = turn_.due()) {
            switch (*act) {
            case Act::receive:
                side_.receive(window, *exchange_);
                break;
            case Act::advance:
                phase("advancing");
                side_.advance(window, report);
                check_report(report, window); // before anything leaves
                break;
            case Act::send:
                side_.send(window, *exchange_);
                break;
            }
            turn_.done();
            if (*act == last_of_ours)
                send_report(report);
        }
    }

    void send_report(v1::Report& report) {
        report.set_window(window_.index);
        report.set_time(window_.time + window_.length);
        fill(*report.mutable_timing());
        control_.post(report_);
    }

    void save(const v1::Save& order) {
        phase("saving");
        if (order.window() + 1 != turn_.next_window())
            throw Error(v1::Failed::PEER,
                        "The orchestrator wants window " + std::to_string(order.window())
                            + " saved where the last one done is "
                            + std::to_string(turn_.next_window()) + " - 1.");
        v1::Checkpoint checkpoint;
        *checkpoint.mutable_version() = version();
        checkpoint.set_role(side_.role());
        checkpoint.set_solver(side_.solver().name());
        checkpoint.set_window(order.window());
        checkpoint.set_time(window_.time + window_.length);
        side_.store(checkpoint);
        checkpoint.set_state(side_.solver().save());
        write_file(in_run_folder(order.path()), checkpoint);
        v1::ToOrchestrator answer;
        answer.mutable_saved()->set_window(order.window());
        control_.send(answer);
    }

    void restore(const v1::Restore& order) {
        phase("restoring");
        const auto path = in_run_folder(order.path());
        std::ifstream file(path, std::ios::binary);
        v1::Checkpoint checkpoint;
        if (!file || !checkpoint.ParseFromIstream(&file))
            throw Error(v1::Failed::INTERNAL,
                        "'" + path.string() + "' is missing or no checkpoint of this protocol.");
        if (checkpoint.role() != side_.role() || checkpoint.solver() != side_.solver().name()
            || checkpoint.window() != order.window())
            throw Error(v1::Failed::INTERNAL,
                        "'" + path.string() + "' holds window "
                            + std::to_string(checkpoint.window()) + " of the "
                            + name_of(checkpoint.role()) + " " + checkpoint.solver()
                            + ", not window " + std::to_string(order.window()) + " of "
                            + side_.solver().name() + ".");
        side_.restore(checkpoint);
        side_.solver().restore(checkpoint.state());
        turn_.resume(checkpoint.window() + 1);
        v1::ToOrchestrator answer;
        answer.mutable_restored()->set_window(checkpoint.window());
        answer.mutable_restored()->set_time(checkpoint.time());
        control_.send(answer);
    }

    void finish() {
        phase("finishing");
        side_.solver().finish();
        v1::ToOrchestrator message;
        fill(*message.mutable_bye()->mutable_timing());
        control_.send(message);
        finished_ = true;
    }

    /// An absolute path stays as it is.
    std::filesystem::path in_run_folder(const std::string& path) const {
        return std::filesystem::path(configure_.run_folder()) / path;
    }

    void fill(v1::Timing& timing) const {
        timing.set_wall(since(start_));
        timing.set_waiting_for_peer(exchange_ ? exchange_->waited() : 0);
        timing.set_waiting_for_lease(waiting_for_lease_);
        timing.set_cpu(cpu_time());
        timing.set_peak_memory(peak_memory());
    }

    void phase(const char* name) { control_.pulse().phase = name; }

    [[noreturn]] void out_of_turn(const std::string& due) const {
        throw Error(v1::Failed::PEER,
                    "The orchestrator sent another message where " + due + " was due.");
    }

    zmq::context_t& context_;
    Side& side_;
    const Arguments& arguments_;
    ControlLink control_;
    v1::Configure configure_;
    std::unique_ptr<Exchange> exchange_; // null without another solver
    Turn turn_{v1::Coupling::FLUID_FIRST, v1::ROLE_SOLID, false};
    Window window_; // the present one
    v1::ToOrchestrator report_;
    Clock::time_point start_{};
    double waiting_for_lease_ = 0; // s
    bool finished_ = false;
};

int serve(Side& side, const Arguments& arguments) {
    const auto complain = [&](const std::string& sentence) {
        std::fprintf(stderr, "%s: %s\n", side.solver().name().c_str(), sentence.c_str());
        return 1;
    };
    try {
        zmq::context_t context;
        Participant participant(context, side, arguments);
        try {
            participant.serve();
            return 0;
        } catch (const Aborted& aborted) {
            return complain(aborted.what());
        } catch (const Error& error) {
            participant.fail(error.code(), error.what());
            return complain(error.what());
        } catch (const std::exception& error) {
            participant.fail(v1::Failed::INTERNAL, error.what());
            return complain(error.what());
        }
    } catch (const std::exception& error) {
        return complain(error.what());
    }
}

[[noreturn]] void print_usage_and_exit(std::FILE* stream, const char* program, int status) {
    std::fprintf(stream,
                 "Usage: %s --connect ADDRESS\n"
                 "A solver of a coupled run. `duet run` starts it; ADDRESS is where the "
                 "orchestrator listens.\n",
                 program);
    std::exit(status);
}

} // namespace

Arguments parse_arguments(int argc, char** argv) {
    const std::string option = argc > 1 ? argv[1] : "";
    const std::string with_value = "--connect=";
    if (option == "--help")
        print_usage_and_exit(stdout, argv[0], 0);
    if (option == "--version") {
        std::printf("protocol %u.%u\n", version().major(), version().minor());
        std::exit(0);
    }
    Arguments arguments;
    if (argc == 3 && option == "--connect")
        arguments.connect = argv[2];
    else if (argc == 2 && option.starts_with(with_value))
        arguments.connect = option.substr(with_value.size());
    if (arguments.connect.empty())
        print_usage_and_exit(stderr, argv[0], 2);
    return arguments;
}

int participate(SolidSolver& solid, const Arguments& arguments) {
    SolidSide side(solid);
    return serve(side, arguments);
}

int participate(FluidSolver& fluid, const Arguments& arguments) {
    FluidSide side(fluid);
    return serve(side, arguments);
}

} // namespace duet::protocol
