// The checks of a scene as a whole: each fault is found, said with its place, and said alone.

#include "orchestrator/geometry.hpp"
#include "orchestrator/scene_check.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace duet::orchestrator {
namespace {

const std::string good = R"(
[time]
end = 1

[fluid]
spacing = 0.1
region = [[0, 0], [4, 0], [4, 4], [0, 4]]
density = 1
kinematic_viscosity = 1

[[fluid.wall]]
name = "lid"
along = [[0, 4], [4, 4]]
velocity = [1, 0]

[[solid.body]]
name = "plate"
rectangle = { corner = [1, 0], width = 2, height = 1 }
element_size = 0.5
density = 1

[[solid.body.boundary]]
name = "foot"
along = [[1, 0], [3, 0]]

[[probe]]
name = "p"
of = "fluid"
quantity = "temperature"
at = [2, 2]
)";

std::string problems(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
        check_scene(parse_case(text, "case.toml", overrides));
    } catch (const CaseError& error) {
        return error.what();
    }
    return "";
}

/// The one fault of the good case with `change`.
void expect_fault(const std::string& change, const std::string& part) {
    const std::string text = problems(good, {change});
    EXPECT_NE(text.find(part), std::string::npos) << change << " gave: " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << change << " gave more: " << text;
}

TEST(SceneCheck, AGoodCasePasses) {
    EXPECT_EQ(problems(good), "");
}

TEST(SceneCheck, ShippedCasesPass) {
    for (const char* name : {"cases/hot_plate", "cases/two_layers", "tests/process/small"})
        EXPECT_NO_THROW(check_scene(read_case(std::string(DUET_SOURCE_DIR "/") + name))) << name;
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

TEST(SceneCheck, Bodies) {
    expect_fault("solid.body[0].rectangle.width=4", "reaches out of fluid.region");
    expect_fault("solid.body[0].element_size=1.5", "larger than the body's shorter side");
    const std::string soft = problems(
        good, {"solid.body[0].motion=\"deformable\"", "solid.body[0].boundary[0].fixed_y=true"});
    EXPECT_EQ(soft, "case.toml:16:1: the deformable body 'plate' lacks the key 'youngs_modulus'");
    expect_fault("solid.body[0].initial_velocity=[1, 0]", "has an initial velocity");
    expect_fault("solid.body[0].support={ fixed_x = true }", "has a support");
    EXPECT_EQ(problems(good,
                       {"solid.body[0].motion=\"rigid\"",
                        "solid.body[0].rectangle.corner=[1, 1]",
                        "solid.body[0].boundary[0].along=[[1, 1], [3, 1]]",
                        "solid.body[0].support={ spring_angle = 2, pivot = [1, 0] }",
                        "solid.body[0].initial_velocity=[1, 0]",
                        "solid.body[0].boundary[0].pressure=3",
                        "probe[0].at=[2, 3]"}),
              "");
    EXPECT_NE(
        problems(good, {"solid.body[0].motion=\"rigid\"", "solid.body[0].boundary[0].fixed_x=true"})
            .find("its 'support' says"),
        std::string::npos);
    expect_fault("solid.body[0].boundary[0].along=[[1, 0.5], [3, 0.5]]",
                 "no side of the body lies between");
    EXPECT_NE(problems(good,
                       {"solid.body[0].boundary[0].temperature=1",
                        "solid.body[0].boundary[0].heat_flux=1"})
                  .find("keep one of them"),
              std::string::npos);
    const std::string second = "[[solid.body]]\nelement_size = 0.5\ndensity = 1\n";
    EXPECT_EQ(problems(good + second
                       + "name = 'b'\nrectangle = { corner = [1, 1], width = 1, height = 1 }\n"),
              "")
        << "bodies may touch";
    EXPECT_NE(problems(good + second
                       + "name = 'b'\nrectangle = { corner = [2, 0.5], width = 1, height = 1 }\n")
                  .find("the bodies 'plate' and 'b' overlap"),
              std::string::npos);
    EXPECT_NE(problems(good + second
                       + "name = 'plate'\nrectangle = { corner = [3, 2], width = 1, height = 1 }\n")
                  .find("the name 'plate' is already taken"),
              std::string::npos);
}

/// The good case's plate, which leans on the floor from [1, 0] to [3, 0], or elsewhere by a change.
const std::string rigid = "solid.body[0].motion=\"rigid\"";
const std::string prescribed = "solid.body[0].motion=\"prescribed\"";
const std::string deformable = "solid.body[0].motion=\"deformable\"";
const std::string modulus = "solid.body[0].youngs_modulus=1";
const std::string to_the_left = "solid.body[0].rectangle.corner=[0, 2]";
const std::string no_boundary = "solid.body[0].boundary=[]";
const std::string probe_above = "probe[0].at=[2, 3.5]";

/// The one fault is at the first change.
void expect_one(const std::vector<std::string>& changes, const std::string& sentence) {
    EXPECT_EQ(problems(good, changes),
              sentence.empty() ? "" : "--set " + changes[0] + ": " + sentence);
}

TEST(SceneCheck, ARigidBodyStaysOnItsWall) {
    const std::string leans = "the body 'plate' leans on the cavity's wall from ";
    const std::string end = ", or move the body away from the wall";
    const auto support = [](const std::string& keys) {
        return "solid.body[0].support={ " + keys + " }";
    };
    const std::string floor = leans + "[1, 0] to [3, 0] and may leave it; give its support ";
    expect_one({rigid}, floor + "fixed_y and fixed_angle" + end);
    expect_one({rigid, support("pivot = [1, 0]")}, floor + "fixed_angle" + end);
    expect_one({rigid, support("fixed_x = true, fixed_angle = true")}, floor + "fixed_y" + end);
    expect_one({rigid, support("fixed_y = true, fixed_angle = true")}, "");
    expect_one({rigid, support("pivot = [1, 0], fixed_angle = true")}, "");
    expect_one({rigid, no_boundary, to_the_left, probe_above, support("fixed_y = true")},
               leans + "[0, 3] to [0, 2] and may leave it; give its support fixed_x and fixed_angle"
                   + end);
    expect_one({rigid,
                no_boundary,
                to_the_left,
                probe_above,
                support("fixed_x = true, fixed_angle = true")},
               "");
    // In a corner each wall asks for its own.
    expect_one({rigid, no_boundary, "solid.body[0].rectangle.corner=[0, 0]"},
               leans
                   + "[0, 0] to [2, 0] and may leave it; give its support fixed_y, fixed_angle and "
                     "fixed_x"
                   + end);
    expect_one({rigid,
                "fluid.hole=[{ name = 'h', corners = [[2, 1], [4, 1], [4, 2], [2, 2]] }]",
                "fluid.region=[[0, -1], [5, -1], [5, 4], [0, 4]]",
                "fluid.wall=[]",
                probe_above},
               "the body 'plate' leans on the wall of the hole 'h' from [2, 1] to "
               "[3, 1] and may leave it; give its support fixed_y and fixed_angle"
                   + end);
}

TEST(SceneCheck, APrescribedMotionStaysOnItsWall) {
    const auto moved = [](const std::string& displacement) {
        return "solid.body[0].displacement=" + displacement;
    };
    const std::string end = " constant, or move the body away from the wall";
    const std::string floor = "the body 'plate' leans on the cavity's wall from "
                              "[1, 0] to [3, 0] and its motion may take it off; keep its ";
    expect_one({prescribed, moved("[0, 't']")}, floor + "displacement along y" + end);
    expect_one({prescribed, "solid.body[0].angle='t'"}, floor + "angle" + end);
    expect_one({prescribed, moved("['t', 0]")}, "");
    expect_one({prescribed, no_boundary, to_the_left, probe_above, moved("[0, 't']")}, "");
    // It counts where the motion starts, not where the body is drawn.
    expect_one({prescribed, moved("[0, '1 + t']")}, "");
    expect_one({prescribed, no_boundary, to_the_left, probe_above, moved("[0, 1]")}, "");
    expect_one(
        {prescribed, no_boundary, to_the_left, probe_above, moved("['t', '1 + t']")},
        "the body 'plate' leans on the cavity's wall from [2, 4] to [0, 4] "
        "and its motion may take it off; keep its displacement along y and displacement along "
        "x" + end);
    expect_one({prescribed, moved("[0, '1/t']")},
               "the body 'plate' has no place at the start: the formula '1/t' has "
               "no finite value at x = 0, y = 0, t = 0.");
}

TEST(SceneCheck, ADeformableBodyIsHeldWhereItLeans) {
    const auto held = [](const std::string& boundaries) {
        return "solid.body[0].boundary=[" + boundaries + "]";
    };
    const std::string fault =
        "the body 'plate' leans on the cavity's wall from [1, 0] to [3, 0] and may "
        "leave it; hold what leans there by a boundary with fixed_y, or move the body away from "
        "the wall";
    expect_one({deformable, modulus}, fault);
    expect_one({deformable, modulus, held("{ name = 'b', curve = 'bottom', fixed_x = true }")},
               fault);
    expect_one({deformable, modulus, held("{ name = 'b', curve = 'top', fixed_y = true }")}, fault);
    expect_one(
        {deformable, modulus, held("{ name = 'b', along = [[1, 0], [2, 0]], fixed_y = true }")},
        fault);
    expect_one({deformable, modulus, held("{ name = 'b', curve = 'bottom', fixed_y = true }")}, "");
    expect_one({deformable,
                modulus,
                held("{ name = 'b', along = [[1, 0], [2, 0]], fixed_y = true }, "
                     "{ name = 'c', along = [[3, 0], [2, 0]], velocity_y = 0 }")},
               "");
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

/// The good case with a triangle from (1, 0) over (3, 0) to (2, 1) from a mesh file as its body.
class MeshBody : public testing::Test {
  protected:
    MeshBody() {
        folder_ =
            std::filesystem::temp_directory_path() / ("duet-mesh-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
        write("3 0 0");
    }
    ~MeshBody() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& second_node) {
        std::ofstream(folder_ / "body.msh")
            << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
               "$PhysicalNames\n2\n1 1 \"foot\"\n2 2 \"steel\"\n$EndPhysicalNames\n"
               "$Entities\n0 1 1 0\n1 0 0 0 1 1 0 1 1 0\n1 0 0 0 1 1 0 1 2 0\n$EndEntities\n"
               "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n1 0 0\n"
            << second_node
            << "\n2 1 0\n$EndNodes\n"
               "$Elements\n2 2 1 2\n1 1 1 1\n1 1 2\n2 1 2 1\n2 1 2 3\n$EndElements\n";
    }

    std::string problems_of(const std::vector<std::string>& overrides = {}) {
        std::string text = good;
        const std::string rectangle = "rectangle = { corner = [1, 0], width = 2, height = 1 }\n"
                                      "element_size = 0.5";
        text.replace(text.find(rectangle), rectangle.size(), "mesh = 'body.msh'");
        std::ofstream(folder_ / "case.toml") << text;
        try {
            check_scene(parse_case(text, (folder_ / "case.toml").string(), overrides));
        } catch (const CaseError& error) {
            return error.what();
        }
        return "";
    }

    std::filesystem::path folder_;
};

TEST_F(MeshBody, IsCheckedBeforeAnythingStarts) {
    const auto expect = [&](const std::string& change, const std::string& words) {
        const std::string found = problems_of({change});
        EXPECT_NE(found.find(words), std::string::npos) << change << " gave: " << found;
    };
    EXPECT_EQ(problems_of(), "");
    EXPECT_EQ(problems_of({"solid.body[0].boundary=[{ name = 'b', curve = 'foot' }]"}), "");
    expect("solid.body[0].boundary=[{ name = 'b', curve = 'feet' }]",
           "no curve 'feet' on its boundary; there is foot");
    expect("solid.body[0].boundary[0].along=[[1, 0], [2, 0.9]]", "no side of the body lies");
    expect("solid.body[0].material=[{ part = 'brass', density = 2 }]",
           "the mesh has no part 'brass'; there is steel");
    expect("solid.body[0].part=['brass']", "has no physical surface 'brass'");
    expect("probe[0].at=[2, 0.5]", "lies in the body 'plate'");
    EXPECT_EQ(problems_of({"probe[0].of=\"solid\"", "probe[0].at=[2, 0.5]"}), "");
    EXPECT_NE(problems_of({"probe[0].of=\"solid\"", "probe[0].at=[1.2, 0.5]"}).find("no body"),
              std::string::npos);
    write("5 0 0");
    expect("solid.body[0].boundary=[]", "reaches out of fluid.region at [5, 0]");
    write("1 0 0");
    expect("solid.body[0].boundary=[]", "no area");
}

TEST_F(MeshBody, StaysOnItsWall) {
    const std::string leans = "leans on the cavity's wall from [1, 0] to [3, 0]";
    EXPECT_NE(problems_of({rigid}).find(leans), std::string::npos) << problems_of({rigid});
    EXPECT_EQ(problems_of({rigid, "solid.body[0].support={ fixed_y = true, fixed_angle = true }"}),
              "");
    EXPECT_NE(problems_of({deformable, modulus}).find(leans), std::string::npos);
    EXPECT_EQ(
        problems_of({deformable,
                     modulus,
                     "solid.body[0].boundary=[{ name = 'b', curve = 'foot', fixed_y = true }]"}),
        "");
}

TEST_F(MeshBody, IsCountedAsItIs) {
    v1::Body body;
    body.set_mesh((folder_ / "body.msh").string());
    EXPECT_EQ(nodes_of(body), 3);
    EXPECT_EQ(area_of(body), 1);
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
} // namespace duet::orchestrator
