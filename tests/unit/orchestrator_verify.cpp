// `duet verify` judges what was measured as the checks say; the numbers here are worked out by
// hand.

#include "orchestrator/verify.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace duet::orchestrator {
namespace {

class Verify : public ::testing::Test {
  protected:
    void SetUp() override {
        file_ = std::filesystem::temp_directory_path()
                / ("duet-verify-" + std::to_string(::getpid()) + ".csv");
        std::ofstream(file_) << "# comment\ns,ramp,flat\n0,0,5\n10,20,5\n";
        v1::Scene& scene = given_.scene;
        scene.mutable_time()->set_end(10);
        scene.mutable_fluid();
        v1::Probe& scalar = *scene.add_probe();
        scalar.set_name("scalar");
        v1::Probe& line = *scene.add_probe();
        line.set_name("line");
        line.add_line();
        line.add_line()->set_x(10);
        result_.histories["scalar"] = {{0, 2.5, 10}, {0.5, 5.5, 19}};
        result_.profiles["line"] = {{10, {0, 5, 10}, {1, 10, 18}}};
        result_.balances.heat = 1e-14;
        result_.players.resize(1);
        result_.players[0].role = v1::ROLE_FLUID;
        (*result_.players[0].ledger.mutable_figure())["particles_outside"] = 3;
        result_.players[0].ledger.set_kinetic_energy(7);
    }
    void TearDown() override { std::filesystem::remove(file_); }

    v1::Check& check(const std::string& quantity, v1::Check::Norm norm, double tolerance) {
        v1::Check& one = *given_.scene.add_check();
        one.set_quantity(quantity);
        one.set_norm(norm);
        one.set_tolerance(tolerance);
        one.set_scale(1);
        one.set_judged(true);
        return one;
    }
    v1::Check& against(v1::Check& one, const std::string& column) {
        one.set_reference(file_.string());
        one.set_column(column);
        return one;
    }
    Verdict only() {
        const std::vector<Verdict> verdicts = judge(given_, result_);
        EXPECT_EQ(verdicts.size(), 1u);
        return verdicts.at(0);
    }

    std::filesystem::path file_;
    Case given_;
    RunResult result_;
};

TEST_F(Verify, AbsoluteAtATime) {
    against(check("scalar", v1::Check::ABSOLUTE, 0.6), "ramp").add_at(2.5);
    const Verdict verdict = only();
    EXPECT_EQ(verdict.quantity, "scalar at 2.5 s");
    EXPECT_EQ(verdict.value, 5.5);
    EXPECT_EQ(verdict.reference, 5) << "linear between the rows";
    EXPECT_EQ(verdict.error, 0.5);
    EXPECT_TRUE(verdict.pass);
}

TEST_F(Verify, RelativeAtTheEndIfNoTimeIsNamed) {
    against(check("scalar", v1::Check::RELATIVE, 0.04), "ramp");
    const Verdict verdict = only();
    EXPECT_DOUBLE_EQ(verdict.error, 0.05);
    EXPECT_FALSE(verdict.pass);
    EXPECT_FALSE(all_pass({verdict}));
}

TEST_F(Verify, ScaleMultipliesTheReference) {
    against(check("scalar", v1::Check::RELATIVE, 0.1), "ramp").set_scale(0.5);
    EXPECT_EQ(only().reference, 10);
    EXPECT_EQ(only().error, 0.9);
}

TEST_F(Verify, OverTime) {
    against(check("scalar", v1::Check::RMS, 1), "ramp");
    EXPECT_DOUBLE_EQ(only().error, std::sqrt((0.25 + 1) / 2));
    given_.scene.mutable_check(0)->set_norm(v1::Check::MAXIMUM);
    EXPECT_EQ(only().error, 1);
    EXPECT_EQ(only().quantity, "scalar over time, maximum");
}

TEST_F(Verify, OverTimeFromATimeOn) {
    against(check("scalar", v1::Check::RMS, 1), "ramp").set_from(3);
    EXPECT_DOUBLE_EQ(only().error, 1);
}

TEST_F(Verify, AlongALine) {
    against(check("line", v1::Check::RMS, 2), "ramp").add_at(10);
    EXPECT_DOUBLE_EQ(only().error, std::sqrt((1.0 + 0 + 4) / 3));
    given_.scene.mutable_check(0)->set_norm(v1::Check::MAXIMUM);
    EXPECT_EQ(only().error, 2);
}

TEST_F(Verify, MeanOverTimeOfAHistory) {
    v1::Check& one = check("scalar", v1::Check::ABSOLUTE, 0.5);
    one.set_value(12);
    one.set_mean_from(2.5);
    EXPECT_EQ(only().quantity, "scalar, mean of 2.5 to 10 s");
    EXPECT_EQ(only().value, 12.25) << "without the record at the start";
    EXPECT_EQ(only().error, 0.25);
}

TEST_F(Verify, MeanOverTimeOfALineIsTakenPointByPoint) {
    result_.profiles["line"].insert(result_.profiles["line"].begin(), {5, {0, 5, 10}, {1, 8, 24}});
    v1::Check& one = against(check("line", v1::Check::MAXIMUM, 2), "ramp");
    one.set_mean_from(4);
    EXPECT_EQ(only().error, 1) << "1, 9 and 21 beside 0, 10 and 20";
}

TEST_F(Verify, FiguresOfTheAuditAndOfALedger) {
    check("heat_balance", v1::Check::ABSOLUTE, 1e-12).set_value(0);
    check("fluid.particles_outside", v1::Check::ABSOLUTE, 0).set_value(0);
    check("fluid.kinetic_energy", v1::Check::ABSOLUTE, 0).set_value(7);
    const std::vector<Verdict> verdicts = judge(given_, result_);
    ASSERT_EQ(verdicts.size(), 3u);
    EXPECT_TRUE(verdicts[0].pass);
    EXPECT_EQ(verdicts[1].value, 3);
    EXPECT_FALSE(verdicts[1].pass);
    EXPECT_TRUE(verdicts[2].pass);
}

TEST_F(Verify, WhatWasNotMeasuredFails) {
    check("scalar", v1::Check::ABSOLUTE, 1e9).add_at(7);
    given_.scene.mutable_check(0)->set_value(0);
    check("solid.nothing", v1::Check::ABSOLUTE, 1e9).set_value(0);
    for (const Verdict& verdict : judge(given_, result_)) {
        EXPECT_FALSE(verdict.pass);
        EXPECT_FALSE(verdict.problem.empty());
        EXPECT_TRUE(std::isnan(verdict.error));
    }
}

TEST_F(Verify, NanNeverPasses) {
    result_.histories["scalar"].value[2] = std::nan("");
    check("scalar", v1::Check::MAXIMUM, 1e9).set_value(0);
    EXPECT_FALSE(only().pass);
}

TEST_F(Verify, WhatIsNotJudgedCannotFail) {
    check("scalar", v1::Check::ABSOLUTE, 0).set_value(0);
    given_.scene.mutable_check(0)->set_judged(false);
    EXPECT_FALSE(only().pass);
    EXPECT_TRUE(all_pass({only()}));
    EXPECT_EQ(verdict_table({only()}, result_).find("FAIL"), std::string::npos);
}

TEST_F(Verify, JsonHoldsWhatItPromises) {
    given_.name = "some";
    check("scalar", v1::Check::ABSOLUTE, 1).set_value(18.5);
    const auto json = nlohmann::json::parse(verdict_json(given_, judge(given_, result_), result_));
    for (const char* key : {"case",
                            "revision",
                            "checks",
                            "cpu_seconds",
                            "peak_memory_bytes",
                            "wall_seconds",
                            "balances"})
        EXPECT_TRUE(json.contains(key)) << key;
    for (const char* key : {"quantity", "value", "reference", "error", "tolerance", "pass"})
        EXPECT_TRUE(json["checks"][0].contains(key)) << key;
    EXPECT_EQ(json["checks"][0]["error"], 0.5);
    EXPECT_EQ(json["checks"][0]["pass"], true);
    EXPECT_TRUE(json["cpu_seconds"].contains("fluid"));
}

} // namespace
} // namespace duet::orchestrator
