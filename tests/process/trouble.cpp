// Runs that go wrong: each ends within 5 s of its trouble being detectable, with a non-zero status,
// one line that says who, when and what, nothing left running, and files that can be read.

#include "process/duet_run.hpp"

#include "orchestrator/case_file.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace duet::test {
namespace {

const std::string small = DUET_SOURCE_DIR "/tests/process/small";
const std::string misbehaving = "/usr/bin/python3 " DUET_SOURCE_DIR "/tests/process/misbehaving.py";
constexpr double patience = 60; // s until a run is under way; generous, for loaded machines
constexpr double promised = 5;  // s from the moment that a trouble is detectable
constexpr double silence = 3;   // s without a heartbeat make a stopped solver detectable

std::size_t lines(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// The files that every failed run leaves, all readable.
void expect_readable(const std::filesystem::path& out) {
    const auto json = nlohmann::json::parse(read(out / "summary.json"));
    EXPECT_EQ(json["ended"], "failed");
    EXPECT_NE(json["failure"], "");
    EXPECT_NO_THROW(orchestrator::read_case(out));
    EXPECT_EQ(read(out / "probes.csv").substr(0, 5), "time,");
    for (const char* name : {"solid.h5", "fluid.h5"})
        if (std::filesystem::exists(out / name)) {
            const std::string command =
                "/usr/bin/python3 -c \"import h5py; f = h5py.File('" + (out / name).string()
                + "', 'r'); assert len(f['frame_000000']['position'][:]) > 0\"";
            EXPECT_EQ(std::system(command.c_str()), 0) << name;
        }
}

/// The run's last words: the line "duet: ..." holds every part, and is followed by the log's place.
void expect_line(const std::string& output, const std::vector<std::string>& parts) {
    const std::size_t at = output.find("duet: ");
    ASSERT_NE(at, std::string::npos) << output;
    const std::string line = output.substr(at, output.find('\n', at) - at);
    for (const std::string& part : parts)
        EXPECT_NE(line.find(part), std::string::npos) << "expected '" << part << "' in: " << line;
    EXPECT_NE(output.find("\nduet: the log is ", at), std::string::npos) << output;
}

void expect_failed(DuetRun& run,
                   double troubled_at,
                   double allowed,
                   const std::filesystem::path& out,
                   const std::vector<std::string>& parts) {
    ASSERT_EQ(run.wait(patience), 1) << run.output();
    EXPECT_LT(run.ended_at() - troubled_at, allowed) << run.output();
    EXPECT_TRUE(run.left_running().empty());
    expect_line(run.output(), parts);
    expect_readable(out);
}

double now() {
    return std::chrono::duration<double>(DuetRun::Clock::now().time_since_epoch()).count();
}

// ------------------------------------------------------------- the real solvers, from outside

struct Blow {
    std::string who;
    int signal;
    double allowed;
    std::string what;
};

std::ostream& operator<<(std::ostream& stream, const Blow& blow) {
    return stream << "signal " << blow.signal << " to the " << blow.who;
}

class RealSolver : public ::testing::TestWithParam<Blow> {};

TEST_P(RealSolver, StruckInMidRun) {
    const Blow& blow = GetParam();
    const Folder folder;
    const std::filesystem::path out = folder / "out";
    DuetRun run(folder, {"run", small, "--output", out.string(), "--set", "time.end=1000"});
    ASSERT_TRUE(eventually(patience, [&] { return lines(read(out / "probes.csv")) > 3; }))
        << run.output();
    const std::string log = read(out / "log.txt");
    const std::size_t at =
        log.find("process ", log.find("the " + blow.who + " is duet-" + blow.who));
    ASSERT_NE(at, std::string::npos) << log;
    ::kill(std::stoi(log.substr(at + 8)), blow.signal);
    expect_failed(run,
                  now(),
                  blow.allowed,
                  out,
                  {"the " + blow.who + " failed in window ", "(t = ", blow.what});
}

INSTANTIATE_TEST_SUITE_P(
    Trouble,
    RealSolver,
    ::testing::Values(Blow{"solid", SIGKILL, promised, "was ended by signal 9 (Killed)"},
                      Blow{"fluid", SIGKILL, promised, "was ended by signal 9 (Killed)"},
                      Blow{"solid", SIGSTOP, silence + promised, "no sign of life for 3 s"},
                      Blow{"fluid", SIGSTOP, silence + promised, "no sign of life for 3 s"}));

// -------------------------------------------------------- solvers that misbehave by themselves

struct Misdeed {
    std::string who;
    std::string how;
    double allowed;
    std::vector<std::string> parts; ///< of the run's last line
    std::vector<std::string> more = {};
};

std::ostream& operator<<(std::ostream& stream, const Misdeed& misdeed) {
    return stream << misdeed.who << " " << misdeed.how;
}

class Misbehaving : public ::testing::TestWithParam<Misdeed> {};

TEST_P(Misbehaving, EndsTheRun) {
    const Misdeed& misdeed = GetParam();
    const Folder folder;
    const std::filesystem::path out = folder / "out";
    std::vector<std::string> arguments = {"run",
                                          small,
                                          "--output",
                                          out.string(),
                                          "--" + misdeed.who,
                                          misbehaving + " " + misdeed.who + " " + misdeed.how};
    arguments.insert(arguments.end(), misdeed.more.begin(), misdeed.more.end());
    DuetRun run(folder, arguments);
    ASSERT_TRUE(run.wait(patience)) << run.output();
    const std::string stamp = read(run.stamp());
    ASSERT_FALSE(stamp.empty()) << "it never came to misbehave:\n"
                                << run.output() << read(out / "log.txt");
    expect_failed(run, std::stod(stamp), misdeed.allowed, out, misdeed.parts);
}

// What a solver says itself names the very window; of one that is struck dumb the last report may
// be lost, and with it the count.
const std::string in_window_5 = "in window 5 (t = 0.0";

INSTANTIATE_TEST_SUITE_P(
    Trouble,
    Misbehaving,
    ::testing::Values(
        Misdeed{"solid", "exit", promised, {"the solid failed in window ", "exited with status 3"}},
        Misdeed{"fluid", "exit", promised, {"the fluid failed in window ", "exited with status 3"}},
        Misdeed{
            "fluid", "leave", promised, {"the fluid failed in window ", "exited with status 0"}},
        Misdeed{"solid", "kill", promised, {"the solid failed in window ", "signal 9"}},
        Misdeed{"fluid",
                "stop",
                silence + promised,
                {"the fluid failed in window ", "no sign of life", "is stopped"}},
        Misdeed{"solid",
                "raise",
                promised,
                {"the solid failed " + in_window_5, "something unforeseen"}},
        Misdeed{"fluid",
                "miscount",
                promised,
                {"the audit failed " + in_window_5, "heat through the interface does not balance"}},
        Misdeed{"fluid", "nan", promised, {"the solid failed " + in_window_5, "nan", "force"}},
        Misdeed{"fluid", "data-garbage", promised, {"the solid failed " + in_window_5}},
        Misdeed{"fluid", "control-garbage", promised, {"the fluid failed in window "}},
        Misdeed{"fluid", "garbage", promised, {"failed before the first window"}},
        Misdeed{"solid", "version", promised, {"failed before the first window", "99"}},
        // Detectable once the time to connect, here 2 s, is over.
        Misdeed{"solid",
                "never-connect",
                2 + promised,
                {"the solid failed before the first window", "has not connected within 2 s"},
                {"--connect-timeout", "2"}}),
    [](const auto& one) {
        std::string name = one.param.who + "_" + one.param.how;
        std::replace(name.begin(), name.end(), '-', '_');
        return name;
    });

// ------------------------------------------------------------------------- before anything starts

TEST(Refused, AMissingProgram) {
    const Folder folder;
    DuetRun run(
        folder,
        {"run", small, "--output", (folder / "out").string(), "--fluid", "/no/such/program"});
    EXPECT_EQ(run.wait(promised), 1);
    EXPECT_NE(run.output().find("there is no program /no/such/program; give another with --fluid"),
              std::string::npos)
        << run.output();
    EXPECT_FALSE(std::filesystem::exists(folder / "out")) << "nothing was started";
}

TEST(Refused, AProgramThatCannotBeRun) {
    const Folder folder;
    const std::filesystem::path program = folder / "program";
    std::ofstream(program) << "\x7f no program";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    DuetRun run(folder,
                {"run", small, "--output", (folder / "out").string(), "--fluid", program.string()});
    EXPECT_EQ(run.wait(promised), 1);
    EXPECT_NE(run.output().find("cannot start " + program.string()), std::string::npos)
        << run.output();
    EXPECT_TRUE(run.left_running().empty()) << "the solid had been started";
}

TEST(Refused, ASecondRunInTheSameFolder) {
    const Folder folder;
    const std::filesystem::path out = folder / "out";
    DuetRun first(folder, {"run", small, "--output", out.string(), "--set", "time.end=1000"});
    ASSERT_TRUE(eventually(patience, [&] { return lines(read(out / "probes.csv")) > 2; }))
        << first.output();
    for (const bool overwrite : {false, true}) {
        std::vector<std::string> arguments = {"run", small, "--output", out.string()};
        if (overwrite)
            arguments.push_back("--overwrite");
        DuetRun second(folder, arguments);
        EXPECT_EQ(second.wait(promised), 1);
        EXPECT_NE(second.output().find("is in use by another run"), std::string::npos)
            << second.output();
    }
    const std::size_t before = lines(read(out / "probes.csv"));
    EXPECT_TRUE(eventually(patience, [&] { return lines(read(out / "probes.csv")) > before; }))
        << "the first goes on";
    first.signal(SIGTERM);
    EXPECT_EQ(first.wait(10), 130);
    DuetRun third(folder, {"run", small, "--output", out.string()});
    EXPECT_EQ(third.wait(promised), 1);
    EXPECT_NE(third.output().find("holds a run already"), std::string::npos) << third.output();
    DuetRun fourth(
        folder, {"run", small, "--output", out.string(), "--overwrite", "--set", "time.end=0.05"});
    EXPECT_EQ(fourth.wait(patience), 0) << fourth.output();
}

TEST(Refused, AFolderThatHoldsSomethingElse) {
    const Folder folder;
    std::ofstream(folder / "letter.txt") << "dear";
    DuetRun run(folder, {"run", small, "--output", (folder / "").string(), "--overwrite"});
    EXPECT_EQ(run.wait(promised), 1);
    EXPECT_NE(run.output().find("holds other files than a run's"), std::string::npos)
        << run.output();
    EXPECT_EQ(read(folder / "letter.txt"), "dear");
}

TEST(Refused, ABadCaseWithAllItsFaults) {
    const Folder folder;
    DuetRun run(folder,
                {"run",
                 small,
                 "--output",
                 (folder / "out").string(),
                 "--set",
                 "fluid.spacing=0",
                 "--set",
                 "fluid.densty=1"});
    EXPECT_EQ(run.wait(promised), 2);
    EXPECT_NE(run.output().find("must be greater than 0"), std::string::npos) << run.output();
    EXPECT_NE(run.output().find("nearest known key: 'density'"), std::string::npos) << run.output();
}

} // namespace
} // namespace duet::test
