// The checks of a scene as a whole: each fault is found, said with its place, and said alone.

#include "orchestrator/geometry.hpp"
#include "tests/unit/orchestrator_support.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace duet::orchestrator::test {
namespace {

TEST(SceneCheck, AGoodCasePasses) {
    EXPECT_EQ(problems(good), "");
}

TEST(SceneCheck, ShippedCasesPass) {
    int checked = 0;
    for (const char* folder : {"cases", "tests/process"})
        for (const auto& file : std::filesystem::recursive_directory_iterator(
                 DUET_SOURCE_DIR "/" + std::string(folder)))
            if (file.path().extension() == ".toml") {
                EXPECT_NO_THROW(check_scene(read_case(file.path()))) << file.path();
                ++checked;
            }
    EXPECT_GT(checked, 10); // the shipped cases, one each at least
}

TEST(SceneCheck, Records) {
    expect_fault("output.interval=1e-7", "more than a million records");
    expect_fault("output.probe_interval=1e-7", "more than a million records");
}

TEST(SceneCheck, Regions) {
    const std::string without =
        "[time]\nend = 1\n[fluid]\nspacing = 0.1\ndensity = 1\nkinematic_viscosity = 1\n";
    const auto fault = [&](const std::string& region) {
        return problems(without + "region = " + region + "\n");
    };
    EXPECT_EQ(fault("[[0, 0], [1, 0], [1, 1], [0.5, 0.2], [0, 1]]"), "");
    EXPECT_NE(fault("[[0, 0], [1, 1], [1, 0], [0, 1]]").find("crosses"), std::string::npos);
    EXPECT_NE(fault("[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]").find("coincide"),
              std::string::npos);
    EXPECT_NE(fault("[[0, 0], [2, 0], [1, 0], [1, 1]]").find("back on itself"), std::string::npos);
    EXPECT_NE(fault("[[0, 0], [2, 0], [2, 1], [1, 0], [0, 1]]").find("lies on the side"),
              std::string::npos);
    EXPECT_NE(fault("[[0, 0], [1, 0], [2, 0]]").find("no simple polygon"), std::string::npos);
    EXPECT_NE(fault("[[0, 0], [0.1, 0], [0.1, 0.1]]").find("more than half the extent"),
              std::string::npos);
}

TEST(SceneCheck, Walls) {
    expect_fault("fluid.wall[0].along=[[0, 4], [3, 4]]", "no side of fluid.region lies between");
    expect_fault("fluid.wall[0].along=[[0, 4], [0, 4]]", "two different points");
    expect_fault("fluid.wall[0].velocity=[1, 1]", "only move along itself");
    EXPECT_NE(problems(good + "[[fluid.wall]]\nname = 'top'\nalong = [[0, 4], [4, 4]]\n")
                  .find("share a side"),
              std::string::npos);
}

TEST(SceneCheck, WhatThePapersFormulationHasNot) {
    const std::string paper = "fluid.formulation=\"paper\"";
    EXPECT_EQ(problems(good, {paper}), "");
    EXPECT_EQ(problems(good, {"fluid.fourth_order=true"}), "");
    EXPECT_NE(problems(good, {paper, "fluid.fourth_order=true"})
                  .find("no Laplacian of fourth order; take the consistent one"),
              std::string::npos);
    EXPECT_NE(problems(good, {paper, "fluid.wall=[{ name = 'w', around = 'region', slip = true }]"})
                  .find("knows no walls that slip"),
              std::string::npos);
}

TEST(SceneCheck, PeriodicRegions) {
    expect_one({"fluid.periodic=\"x\""}, "");
    expect_fault("fluid.periodic=\"z\"", "none, x, y or both");
    const std::string y = "fluid.periodic=\"y\"", x = "fluid.periodic=\"x\"";
    EXPECT_NE(problems(good, {y}).find("the wall 'lid' lies on the side from [4, 4] to [0, 4]"),
              std::string::npos)
        << problems(good, {y});
    EXPECT_NE(problems(good, {y}).find("the body 'plate' reaches the periodic side"),
              std::string::npos)
        << problems(good, {y});
    const auto expect = [&](const std::string& change, const std::string& part) {
        const std::string text = problems(good, {change, x});
        EXPECT_NE(text.find(part), std::string::npos) << change << " gave: " << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << change << " gave more: " << text;
    };
    expect("fluid.spacing=0.7", "shorter than six spacings");
    expect("fluid.region=[[0, 0], [4, 0], [4, 4], [1, 4], [0, 3]]", "needs a rectangle");
    expect("solid.body[0].rectangle.corner=[0, 0]", "reaches the periodic side");
    const std::string bare = good.substr(0, good.find("[[fluid.wall]]"));
    EXPECT_NE(problems(bare + "[[fluid.wall]]\nname = 'all'\naround = 'region'\n", {x})
                  .find("goes round a region that is periodic"),
              std::string::npos);
    EXPECT_EQ(problems(bare, {"fluid.periodic=\"both\""}), "");
}

TEST(SceneCheck, Probes) {
    expect_fault("probe[0].at=[5, 2]", "lies outside fluid.region");
    expect_fault("probe[0].at=[2, 0.5]", "lies in the body 'plate'");
    expect_fault("probe[0].of=\"solid\"", "lies in no body");
}

TEST(SceneCheck, InitialState) {
    const std::filesystem::path file = std::filesystem::temp_directory_path()
                                       / ("duet-state-" + std::to_string(getpid()) + ".csv");
    const std::string change = "fluid.initial_state=\"" + file.string() + "\"";
    std::ofstream(file) << "x,y,temperature\n0,0,1\n1,0,warm\n0,1,1\n";
    expect_one({change}, file.string() + ", line 3: 'warm' is no finite number");
    std::ofstream(file) << "x,y,temperature\n0,0,1\n1,0,2\n0,1,1\n";
    expect_one({change}, "");
    std::filesystem::remove(file);
}

TEST(SceneCheck, ProbeNamesAndPlaces) {
    EXPECT_EQ(problems(good, {"probe[0].mirror=2.5"}), "");
    expect_fault("probe[0].mirror=0.5", "the point [-1, 2] (the mirror image) lies outside");
    expect_fault("probe[0].line=[[1, 2], [2, 2]]", "not both");
    expect_fault("fluid.disc={ centre = [2, 2], radius = 1 }", "either 'region', the corners");
    expect_fault("fluid.hole=[{ name = 'h', corners = [[1, 2], [2, 2], [2, 5]] }]",
                 "the hole 'h' reaches the boundary of the cavity");
    expect_fault("fluid.hole=[{ name = 'h', disc = { centre = [2, 2], radius = 0.5 } }]",
                 "the point [2, 2] lies in the hole 'h'");
    expect_fault("fluid.hole=[{ name = 'h' }]", "fluid.hole[0] needs either 'corners' or 'disc'");
    expect_fault("fluid.wall[0].slip=true", "give it no velocity");
    EXPECT_NE(problems(good,
                       {"fluid.region=[[0, 0], [4, 0], [4, 4], [2, 4], [0, 3]]",
                        "fluid.wall=[{ name = 'w', around = 'region', slip = true }]"})
                  .find("slips from [2, 4] to [0, 3], which is not along an axis"),
              std::string::npos);
    expect_fault("fluid.wall=[{ name = 'w', around = 'region', temperature = 1, heat_flux = 't' }]",
                 "prescribes a temperature and a heat flux");
    expect_fault("fluid.wall=[{ name = 'w', around = 'core' }]", "there is no hole 'core'");
    expect_fault("fluid.wall=[{ name = 'w' }]", "needs either 'along', two points, or 'around'");
    expect_fault("probe[0].wall=\"lit\"", "there is no wall 'lit'; did you mean 'lid'?");
    expect_fault("probe[0].boundary=\"foot\"", "a probe of the fluid takes a wall");
    expect_fault("probe[0].body=\"plate\"", "a probe of the fluid takes a wall");
    expect_fault("probe[0].name=\"a,b\"", "must be a word");
    EXPECT_NE(problems(good + "[[probe]]\nname = 'p'\nof = 'fluid'\nquantity = 'q'\n")
                  .find("already taken"),
              std::string::npos);
    EXPECT_NE(
        problems(good + "[[probe]]\nname = 'q'\nof = 'fluid'\nquantity = 'q'\nline = [[1, 2]]\n")
            .find("two different end points"),
        std::string::npos);
    EXPECT_NE(problems("[time]\nend = 1\n[[probe]]\nname = 'q'\nof = 'fluid'\nquantity = 'q'\n")
                  .find("nothing to model"),
              std::string::npos);
}

class Checks : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ =
            std::filesystem::temp_directory_path() / ("duet-check-" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
        write("good.csv", "# origin\nt, T\n0, 1\n1, 3\n");
        write("words.csv", "t,T\n0,one\n");
        write("short.csv", "t,T\n0\n");
        write("back.csv", "t,T\n1,0\n0,0\n");
        write("brief.csv", "t,T\n0,0\n0.5,0\n");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    void write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
    }

    std::string with(const std::string& check) {
        try {
            check_scene(
                parse_case(good + "[[check]]\ntolerance = 1\n" + check, folder_ / "case.toml"));
        } catch (const CaseError& error) {
            return error.what();
        }
        return "";
    }
    void expect_fault_with(const std::string& check, const std::string& part) {
        const std::string text = with(check);
        EXPECT_NE(text.find(part), std::string::npos) << check << " gave: " << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << check << " gave more: " << text;
    }

    std::filesystem::path folder_;
};

TEST_F(Checks, GoodOnesPass) {
    EXPECT_EQ(with("quantity = 'p'\nreference = 'good.csv'\ncolumn = 'T'\nat = [0, 0.5, 1]\n"), "");
    EXPECT_EQ(with("quantity = 'heat_balance'\nvalue = 0\n"), "");
    EXPECT_EQ(with("quantity = 'fluid.anything'\nvalue = 0\n"), "");
}

TEST_F(Checks, Faults) {
    const std::string of_p = "quantity = 'p'\n";
    expect_fault_with("quantity = 'p'\nvalue = 0\nmean_from = 0.5\nat = [0.9, 0.4]\n",
                      "lies after the time at which the check is held, 0.4 s");
    expect_fault_with("quantity = 'heat_balance'\nvalue = 0\nmean_from = 0.5\n",
                      "a mean over time is taken of a probe");
    expect_fault_with("quantity = 'heat_ballance'\nvalue = 0\n", "did you mean 'heat_balance'?");
    expect_fault_with("quantity = 'heat_balance'\nvalue = 0\nat = [1]\n",
                      "belongs to the whole run");
    expect_fault_with(of_p + "value = 0\nat = [2]\n", "the time 2 lies outside the run, 0 to 1 s");
    expect_fault_with(of_p + "value = 0\nnorm = 'relative'\n", "cannot be relative to 0");
    expect_fault_with(of_p, "either a 'value' or a 'reference'");
    expect_fault_with(of_p + "value = 1\nreference = 'good.csv'\ncolumn = 'T'\n",
                      "either a 'value'");
    expect_fault_with(of_p + "reference = 'good.csv'\ncolumn = 'temperature'\n",
                      "there is t and T");
    expect_fault_with(of_p + "reference = 'good.csv'\ncolumn = 'T'\nalong = 'x'\n",
                      "no column 'x'");
    expect_fault_with(of_p + "reference = 'words.csv'\ncolumn = 'T'\n",
                      "words.csv:2: 'one' is not a number");
    expect_fault_with(of_p + "reference = 'short.csv'\ncolumn = 'T'\n",
                      "expected 2 numbers, found 1");
    expect_fault_with(of_p + "reference = 'back.csv'\ncolumn = 'T'\n", "does not ascend");
    expect_fault_with(of_p + "reference = 'brief.csv'\ncolumn = 'T'\nat = [0.7]\n",
                      "0.7 lies outside 0 to 0.5");
}

TEST(SceneCheck, AShortenedRunLeavesLaterChecksOut) {
    const std::string check =
        good + "\n[[check]]\nquantity = \"p\"\nvalue = 0\ntolerance = 1\nat = ";
    Case given = parse_case(
        check + "[0.25, 1]\n" + check.substr(good.size()) + "[1]\n", "case.toml", {"time.end=0.5"});
    EXPECT_NO_THROW(check_scene(given));
    leave_out_later_checks(given);
    ASSERT_EQ(given.scene.check_size(), 1);
    ASSERT_EQ(given.scene.check(0).at_size(), 1);
    EXPECT_EQ(given.scene.check(0).at(0), 0.25);
}

TEST(Geometry, InsideAndOverlapCountTouchingAsTheySay) {
    const Polygon l = {
        point(0, 0), point(2, 0), point(2, 1), point(1, 1), point(1, 2), point(0, 2)};
    EXPECT_TRUE(inside(l, point(0.5, 1.5), 1e-9));
    EXPECT_TRUE(inside(l, point(1, 1.5), 1e-9)) << "the boundary belongs to it";
    EXPECT_FALSE(inside(l, point(1.5, 1.5), 1e-9));
    EXPECT_EQ(area(l), 3);
    v1::Rectangle r;
    *r.mutable_corner() = point(0, 0);
    r.set_width(2);
    r.set_height(2);
    EXPECT_FALSE(rectangle_inside(r, l, 1e-9)) << "all but one corner are inside";
    r.set_height(1);
    EXPECT_TRUE(rectangle_inside(r, l, 1e-9));
    // A rectangle across the notch of a U has its corners inside and its middle outside.
    const Polygon u = {point(0, 0),
                       point(3, 0),
                       point(3, 2),
                       point(2, 2),
                       point(2, 1),
                       point(1, 1),
                       point(1, 2),
                       point(0, 2)};
    *r.mutable_corner() = point(0.5, 0.5);
    r.set_width(2);
    r.set_height(1);
    EXPECT_FALSE(rectangle_inside(r, u, 1e-9));
}

} // namespace
} // namespace duet::orchestrator::test
