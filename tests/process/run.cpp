// Runs that go well, from the command line to the files.

#include "process/duet_run.hpp"

#include "orchestrator/case_file.hpp"

#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace duet::test {
namespace {

const std::string small = DUET_SOURCE_DIR "/tests/process/small";
const std::string examples = DUET_SOURCE_DIR "/protocol/examples/";
constexpr double patience = 60; // s; generous, for loaded machines

std::size_t lines(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

nlohmann::json summary(const std::filesystem::path& run) {
    return nlohmann::json::parse(read(run / "summary.json"));
}

TEST(Run, LeavesACompleteFolder) {
    const Folder folder;
    const std::filesystem::path out = folder / "out";
    DuetRun run(folder, {"run", small, "--output", out.string(), "--set", "output.coupling=true"});
    ASSERT_EQ(run.wait(patience), 0) << run.output();
    EXPECT_TRUE(run.left_running().empty());
    EXPECT_NE(run.output().find("the results are in " + out.string()), std::string::npos);
    for (const char* name : {"case.toml",
                             "log.txt",
                             "solid.h5",
                             "solid.xdmf",
                             "fluid.h5",
                             "fluid.xdmf",
                             "coupling.h5",
                             "probes.csv",
                             "summary.json"})
        EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
    EXPECT_EQ(read(out / "probes.csv").substr(0, 26), "time,plate_mean,fluid_mean");
    EXPECT_EQ(lines(read(out / "probes.csv")), 6u) << "a heading, the start, four records";

    const auto json = summary(out);
    EXPECT_EQ(json["ended"], "finished");
    EXPECT_EQ(json["time"], 0.2);
    EXPECT_EQ(json["windows"], 100) << "0.2 s in fixed windows of 0.002 s";
    EXPECT_LE(json["balances"]["heat"], 1e-12);
    for (const char* who : {"solid", "fluid"}) {
        EXPECT_GE(json["processes"][who]["steps"], 100) << who;
        EXPECT_GT(json["processes"][who]["cpu_seconds"], 0) << who;
        EXPECT_GT(json["processes"][who]["peak_memory_bytes"], 1e6) << who;
        EXPECT_TRUE(json["processes"][who].contains("waiting_for_peer_seconds")) << who;
    }
}

TEST(Run, TheFoldersCaseIsTheCaseAsRun) {
    const Folder folder;
    const std::filesystem::path out = folder / "out";
    DuetRun run(folder,
                {"run",
                 small,
                 "--output",
                 out.string(),
                 "--set",
                 "time.end=0.05",
                 "--set",
                 "fluid.density=2"});
    ASSERT_EQ(run.wait(patience), 0) << run.output();
    const auto given = orchestrator::read_case(small, {"time.end=0.05", "fluid.density=2"});
    EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(
        given.scene, orchestrator::read_case(out).scene));
}

TEST(Run, WindowsFromStableStepsAreTheSameEveryTime) {
    const Folder folder;
    for (const char* out : {"a", "b"}) {
        DuetRun run(folder,
                    {"run",
                     small,
                     "--output",
                     (folder / out).string(),
                     "--set",
                     "time.window=0",
                     "--set",
                     "time.end=2"});
        ASSERT_EQ(run.wait(patience), 0) << run.output();
    }
    EXPECT_EQ(read(folder / "a/probes.csv"), read(folder / "b/probes.csv")) << "to the last bit";
}

TEST(Run, TheOtherSchedulesRunAndBalance) {
    for (const char* schedule : {"solid_first", "parallel"}) {
        // With windows of one length, and of changing ones: the load in flight keeps its impulse
        // and heat.
        for (const char* window : {"0.002", "0"}) {
            const Folder folder;
            DuetRun run(folder,
                        {"verify",
                         small,
                         "--output",
                         (folder / "out").string(),
                         "--set",
                         std::string("coupling.schedule=\"") + schedule + "\"",
                         "--set",
                         std::string("time.window=") + window});
            EXPECT_EQ(run.wait(patience), 0) << schedule << "\n" << run.output();
        }
    }
}

TEST(Run, EitherSolverMayBeInPython) {
    for (const auto& [option, program] :
         {std::pair("--solid", "minimal_solid.py"), std::pair("--fluid", "minimal_fluid.py")}) {
        const Folder folder;
        DuetRun run(folder,
                    {"verify",
                     small,
                     "--output",
                     (folder / "out").string(),
                     option,
                     "/usr/bin/python3 " + examples + program});
        EXPECT_EQ(run.wait(patience), 0) << program << "\n" << run.output();
        EXPECT_NE(read(folder / "out/log.txt").find(program), std::string::npos);
    }
}

TEST(Run, WithoutASolidNoSolidProcessStarts) {
    const Folder folder;
    const std::string fluid_alone = (folder / "case.toml").string();
    std::ofstream(fluid_alone)
        << "[time]\nend = 0.05\n[fluid]\nspacing = 0.1\nregion = [[0, 0], [1, 0], [1, 1], [0, 1]]\n"
           "density = 1\nkinematic_viscosity = 1\n[[fluid.wall]]\nname = 'lid'\n"
           "along = [[0, 1], [1, 1]]\nvelocity = [1, 0]\n";
    DuetRun run(
        folder,
        {"run", fluid_alone, "--output", (folder / "out").string(), "--solid", "/no/such/program"});
    EXPECT_EQ(run.wait(patience), 0) << run.output();
    EXPECT_FALSE(summary(folder / "out")["processes"].contains("solid"));
}

TEST(Run, WithoutAFluidNoFluidProcessStarts) {
    const Folder folder;
    const std::string solid_alone = (folder / "case.toml").string();
    std::ofstream(solid_alone) << "[time]\nend = 0.05\n[[solid.body]]\nname = 'b'\n"
                                  "rectangle = { corner = [0, 0], width = 1, height = 1 }\n"
                                  "element_size = 0.25\ndensity = 1\nconductivity = 1\n";
    DuetRun run(
        folder,
        {"run", solid_alone, "--output", (folder / "out").string(), "--fluid", "/no/such/program"});
    EXPECT_EQ(run.wait(patience), 0) << run.output();
    EXPECT_FALSE(summary(folder / "out")["processes"].contains("fluid"));
}

TEST(Run, ASolverMayBeStartedByHand) {
    const Folder folder;
    DuetRun run(folder, {"run", small, "--output", (folder / "out").string(), "--fluid-by-hand"});
    std::string command;
    ASSERT_TRUE(eventually(patience, [&] {
        const std::string output = run.output();
        const std::size_t at = output.find("OMP_NUM_THREADS");
        if (at == std::string::npos || output.find('\n', at) == std::string::npos)
            return false;
        command = output.substr(at, output.find('\n', at) - at);
        return true;
    })) << run.output();
    std::thread user([&] { EXPECT_EQ(std::system((command + " 2>/dev/null").c_str()), 0); });
    EXPECT_EQ(run.wait(patience), 0) << run.output();
    user.join();
}

TEST(Run, CtrlCEndsCleanlyAtTheWindowsEnd) {
    const Folder folder;
    const std::filesystem::path out = folder / "out";
    DuetRun run(folder, {"run", small, "--output", out.string(), "--set", "time.end=1000"});
    ASSERT_TRUE(eventually(patience, [&] { return lines(read(out / "probes.csv")) > 3; }))
        << run.output();
    run.signal(SIGINT);
    EXPECT_EQ(run.wait(10), 130) << run.output();
    EXPECT_TRUE(run.left_running().empty());
    const auto json = summary(out);
    EXPECT_EQ(json["ended"], "interrupted");
    EXPECT_GT(json["time"], 0.1);
    EXPECT_EQ(json["processes"]["fluid"]["ended"], "exited with status 0")
        << "it was dismissed, not killed";
}

TEST(Run, AKilledOrchestratorLeavesNothingRunning) {
    const Folder folder;
    const std::filesystem::path out = folder / "out";
    DuetRun run(folder, {"run", small, "--output", out.string(), "--set", "time.end=1000"});
    ASSERT_TRUE(eventually(patience, [&] { return lines(read(out / "probes.csv")) > 3; }))
        << run.output();
    EXPECT_EQ(run.left_running().size(), 3u) << "duet and two solvers";
    run.signal(SIGKILL);
    EXPECT_EQ(run.wait(5), 128 + SIGKILL);
    EXPECT_TRUE(eventually(5, [&] { return run.left_running().empty(); }));
}

TEST(Run, NorDoesItLeaveASolverThatListensToNobody) {
    const Folder folder;
    const std::string deaf =
        "/usr/bin/python3 " DUET_SOURCE_DIR "/tests/process/misbehaving.py solid never-connect";
    DuetRun run(folder, {"run", small, "--output", (folder / "out").string(), "--solid", deaf});
    ASSERT_TRUE(eventually(patience, [&] { return !read(run.stamp()).empty(); })) << run.output();
    run.signal(SIGKILL);
    EXPECT_EQ(run.wait(5), 128 + SIGKILL);
    EXPECT_TRUE(eventually(5, [&] { return run.left_running().empty(); }));
}

TEST(Verify, ExitStatusAndJsonTellTheVerdict) {
    const Folder folder;
    const std::filesystem::path json_file = folder / "verdict.json";
    DuetRun good(
        folder,
        {"verify", small, "--output", (folder / "a").string(), "--json", json_file.string()});
    EXPECT_EQ(good.wait(patience), 0) << good.output();
    EXPECT_EQ(nlohmann::json::parse(read(json_file))["checks"][0]["pass"], true);
    DuetRun bad(folder,
                {"verify",
                 small,
                 "--output",
                 (folder / "b").string(),
                 "--json",
                 json_file.string(),
                 "--set",
                 "check[0].value=1"});
    EXPECT_EQ(bad.wait(patience), 1) << bad.output();
    EXPECT_EQ(nlohmann::json::parse(read(json_file))["checks"][0]["pass"], false);
}

TEST(Check, PrintsWhatIsModelledAndStartsNothing) {
    const Folder folder;
    DuetRun run(folder, {"check", small, "--set", "solid.body[0].density=1"});
    EXPECT_EQ(run.wait(patience), 0);
    EXPECT_NE(run.output().find("336 particles"), std::string::npos) << run.output();
    EXPECT_NE(run.output().find("81 nodes"), std::string::npos) << run.output();
    EXPECT_NE(run.output().find("mechanics: left out"), std::string::npos) << run.output();
    // rho c dx_s / 2 * 0.5 dx / k = 1 * 0.25 * 0.25 = 0.0625 s
    EXPECT_NE(run.output().find("windows up to 0.0312 s are stable"), std::string::npos)
        << run.output();
}

} // namespace
} // namespace duet::test
