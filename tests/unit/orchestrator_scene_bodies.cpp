// The checks of bodies in a scene: shapes, meshes, and what leans on walls.

#include "orchestrator/geometry.hpp"
#include "tests/unit/orchestrator_support.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace duet::orchestrator::test {
namespace {

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

} // namespace
} // namespace duet::orchestrator::test
