// duet: the command that people type.

#include "orchestrator/case_file.hpp"
#include "orchestrator/check_report.hpp"
#include "orchestrator/revision.hpp"
#include "orchestrator/run.hpp"
#include "orchestrator/scene_check.hpp"
#include "orchestrator/summary.hpp"
#include "orchestrator/sweep.hpp"
#include "orchestrator/verify.hpp"

#include <CLI/CLI.hpp>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace {

using namespace duet::orchestrator;

constexpr int wrong_usage = 2;

struct Arguments {
    std::string where;
    std::vector<std::string> overrides;
    std::string json;
    RunOptions run;
};

Case checked_case(const Arguments& arguments) {
    Case given = read_case(arguments.where, arguments.overrides);
    check_scene(given);
    leave_out_later_checks(given);
    return given;
}

std::uint32_t threads_of(const Arguments& arguments) {
    return arguments.run.threads > 0 ? arguments.run.threads : default_threads();
}

/// Says where to look, or who failed, when, and with what.
void say_ending(const RunResult& result) {
    const std::string folder = result.folder.string();
    if (result.ended == Ended::failed)
        std::cerr << "duet: " << result.failure << "\n"
                  << "duet: the log is " << folder
                  << "/log.txt; the results until then are kept beside it\n";
    else
        std::cout << (result.ended == Ended::finished ? "finished" : "stopped")
                  << " at t = " << result.time << " s after " << result.wall_seconds
                  << " s; the results are in " << folder << "\n";
}

int run(const Arguments& arguments) {
    const RunResult result = run_case(checked_case(arguments), arguments.run);
    say_ending(result);
    return exit_status(result);
}

int check(const Arguments& arguments) {
    const Case given = checked_case(arguments);
    std::cout << check_report(given, threads_of(arguments));
    return 0;
}

int verify(const Arguments& arguments) {
    const Case given = checked_case(arguments);
    if (given.scene.check_size() == 0)
        throw std::runtime_error("the case " + given.file.string()
                                 + " holds no [[check]] to verify");
    std::ofstream file; // opened, and so emptied, before the run: no verdict of an older one is
                        // taken for this one's
    if (!arguments.json.empty()) {
        file.open(arguments.json);
        if (!file)
            throw std::runtime_error("cannot write " + arguments.json + ": "
                                     + std::strerror(errno));
    }
    const RunResult result = run_case(given, arguments.run);
    say_ending(result);
    if (result.ended != Ended::finished)
        return exit_status(result);
    const std::vector<Verdict> verdicts = judge(given, result);
    std::cout << "\n" << verdict_table(verdicts, result);
    const std::string json = verdict_json(given, verdicts, result);
    std::ofstream(result.folder / "verify.json") << json;
    if (!arguments.json.empty() && !(file << json << std::flush))
        throw std::runtime_error("cannot write " + arguments.json + ": " + std::strerror(errno));
    std::cout << (all_pass(verdicts) ? "all checks pass\n" : "some checks FAIL\n");
    return all_pass(verdicts) ? 0 : 1;
}

/// Runs every variant through the same path as `verify`, and rewrites the table after each, so that
/// what is done is kept whatever comes.
int sweep(Arguments& arguments) {
    const std::vector<Variant> variants = variants_of(arguments.overrides);
    std::vector<Case> cases; // all are checked before the first one runs
    for (const Variant& variant : variants) {
        arguments.overrides = variant.overrides;
        cases.push_back(checked_case(arguments));
        if (cases.back().scene.check_size() == 0)
            throw std::runtime_error("the case " + cases.back().file.string()
                                     + " holds no [[check]] to measure its error");
    }
    const std::filesystem::path folder = arguments.run.output.empty()
                                             ? "runs/sweep-" + cases[0].name
                                             : arguments.run.output.string();
    std::filesystem::create_directories(folder);
    std::vector<Trial> trials;
    int status = 0;
    for (std::size_t i = 0; i < variants.size(); ++i) {
        arguments.run.output = folder / std::to_string(i + 1);
        Trial& trial = trials.emplace_back(Trial{variants[i], {}, {}});
        trial.result = run_case(cases[i], arguments.run);
        say_ending(trial.result);
        if (trial.result.ended == Ended::interrupted)
            return exit_status(trial.result);
        if (trial.result.ended == Ended::finished)
            trial.verdicts = judge(cases[i], trial.result);
        else
            status = 1;
        std::ofstream(folder / "sweep.csv") << sweep_csv(trials);
        std::ofstream json(folder / "sweep.json");
        if (!(json << sweep_json(cases[0], trials) << std::flush))
            throw std::runtime_error("cannot write " + (folder / "sweep.json").string() + ": "
                                     + std::strerror(errno));
    }
    std::cout << "\n"
              << sweep_csv(trials) << "\nthe table is " << (folder / "sweep.csv").string() << "\n";
    return status;
}

void add_case(CLI::App& command, Arguments& arguments) {
    command.add_option("CASE", arguments.where, "a folder with case.toml, or a file")->required();
    command
        .add_option("--set", arguments.overrides, "replace a key of the case: fluid.spacing=0.2")
        ->type_name("KEY=VALUE")
        ->take_all()
        ->allow_extra_args(false);
    command
        .add_option(
            "--threads", arguments.run.threads, "threads of each solver; default: all cores")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
}

void add_run(CLI::App& command, Arguments& arguments) {
    RunOptions& run = arguments.run;
    add_case(command, arguments);
    command.add_option("--output", run.output, "the run folder; default: runs/<case>-<time>")
        ->type_name("DIR");
    command.add_flag("--overwrite", run.overwrite, "replace the run that the folder holds");
    command.add_option("--solid", run.solid, "another program for the solid")->type_name("PROGRAM");
    command.add_option("--fluid", run.fluid, "another program for the fluid")->type_name("PROGRAM");
    command.add_flag(
        "--solid-by-hand",
        run.solid_by_hand,
        "print the solid's command line and wait until you start it, e.g. in a debugger");
    command.add_flag("--fluid-by-hand", run.fluid_by_hand, "the same for the fluid");
    command
        .add_option("--connect-timeout",
                    run.connect_timeout,
                    "how long a solver may take to connect; default: 10")
        ->type_name("SECONDS")
        ->check(CLI::PositiveNumber);
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("duet: a solid and a fluid solver, led through one simulation", "duet");
    app.set_version_flag("--version",
                         std::string("duet ") + DUET_VERSION + " (" + revision() + ")");
    app.require_subcommand(1);
    Arguments arguments;
    int status = 0;

    CLI::App& run_command = *app.add_subcommand("run", "run a case");
    add_run(run_command, arguments);
    run_command.callback([&] { status = run(arguments); });
    CLI::App& check_command =
        *app.add_subcommand("check", "check a case, and say what it will model and cost");
    add_case(check_command, arguments);
    check_command.callback([&] { status = check(arguments); });
    CLI::App& verify_command =
        *app.add_subcommand("verify", "run a case and hold it against its references");
    add_run(verify_command, arguments);
    verify_command.add_option("--json", arguments.json, "write the table as JSON too")
        ->type_name("FILE");
    verify_command.callback([&] { status = verify(arguments); });
    CLI::App& sweep_command = *app.add_subcommand(
        "sweep",
        "run a case for every combination of listed values, --set fluid.spacing=[0.2, 0.1], and "
        "tabulate errors and cost");
    add_run(sweep_command, arguments);
    sweep_command.callback([&] { status = sweep(arguments); });
    CLI::App& reference_command = *app.add_subcommand("reference", "print docs/case-file.md");
    reference_command.group("");
    reference_command.callback([] { std::cout << case_file_reference(); });

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : wrong_usage;
    } catch (const CaseError& error) {
        std::cerr << error.what() << "\n";
        return wrong_usage;
    } catch (const std::invalid_argument& error) {
        std::cerr << "duet: " << error.what() << "\n";
        return wrong_usage;
    } catch (const std::exception& error) {
        std::cerr << "duet: " << error.what() << "\n";
        return 1;
    }
    return status;
}
