// Meshes from files, and the shapes that are built in.

#include "solid_solver/body.hpp"
#include "solid_solver/mesh_file.hpp"
#include "solid_solver/msh_reader.hpp"
#include "solid_solver/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

namespace duet::solid {
namespace {

/// Two unit squares of two triangles each, "steel" at the left and "brass" at the right, the second
/// one drawn clockwise; the curve "clamp" is the left side, "joint" lies between them.
std::string two_squares() {
    return R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
4
1 1 "clamp"
1 2 "joint"
2 3 "steel"
2 4 "brass"
$EndPhysicalNames
$Entities
1 2 2 0
7 0 0 0 0
1 0 0 0 0 1 0 1 1 0
2 1 0 0 1 1 0 1 -2 0
1 0 0 0 1 1 0 1 3 0
2 1 0 0 2 1 0 1 4 0
$EndEntities
$Nodes
2 7 1 9
0 7 0 1
9
5 5 0
2 1 0 6
1
2
3
4
5
6
0 0 0
1 0 0
2 0 0
0 1 0
1 1 0
2 1 0
$EndNodes
$Elements
5 7 1 7
0 7 15 1
1 9
1 1 1 1
2 1 4
1 2 1 1
3 2 5
2 1 2 2
4 1 2 5
5 1 5 4
2 2 2 2
6 2 6 3
7 2 5 6
$EndElements
)";
}

Mesh read(const std::string& text, const std::vector<std::string>& parts = {}) {
    std::istringstream file(text);
    return read_msh(file, "two.msh", parts);
}

std::string refusal(const std::string& text, const std::vector<std::string>& parts = {}) {
    try {
        read(text, parts);
    } catch (const std::invalid_argument& fault) {
        return fault.what();
    }
    return "";
}

std::string with(const std::string& from, const std::string& to) {
    std::string text = two_squares();
    return text.replace(text.find(from), from.size(), to);
}

TEST(SolidMsh, PartsAndCurvesKeepTheirNames) {
    const Mesh mesh = read(two_squares());
    EXPECT_NO_THROW(check_mesh(mesh)); // the clockwise surface has been turned
    EXPECT_NEAR(mesh_area(mesh), 2, 1e-15);
    EXPECT_EQ(mesh.node.size(), 6u); // the stray point is left out
    EXPECT_EQ(mesh.part_name, (std::vector<std::string>{"steel", "brass"}));
    EXPECT_EQ(mesh.part, (std::vector<std::uint32_t>{0, 0, 1, 1}));
    ASSERT_EQ(mesh.curve.size(), 2u);
    EXPECT_EQ(mesh.curve[0].name, "clamp");
    const auto [a, b] = mesh.curve[0].edge.at(0);
    EXPECT_EQ(mesh.node[a], Point(0, 0));
    EXPECT_EQ(mesh.node[b], Point(0, 1));
}

TEST(SolidMsh, ABodyOfSeveralPartsHasAMaterialForEach) {
    BodyConfig body;
    body.name = "plate";
    body.mesh = read(two_squares());
    body.material.density = 3;
    EXPECT_EQ(body.materials().size(), 2u);
    EXPECT_EQ(body.materials().at(1).density, 3);
    EXPECT_NEAR(Body(body).mass(), 6, 1e-14);
    body.part_material = {Material{}};
    EXPECT_THROW(Body{body}, std::invalid_argument);
}

TEST(SolidMsh, ASurfaceOfSeveralGroupsBelongsToTheOneAskedFor) {
    // The left square is "steel" and "brass".
    const std::string both = with("1 0 0 0 1 1 0 1 3 0", "1 0 0 0 1 1 0 2 3 4 0");
    EXPECT_EQ(read(both, {"steel"}).triangle.size(), 2u);
    const Mesh brass = read(both, {"brass"});
    EXPECT_EQ(brass.triangle.size(), 4u);
    EXPECT_EQ(brass.part_name, std::vector<std::string>{"brass"});
    EXPECT_NE(refusal(both).find("line 46: the surface 1 belongs to several"), std::string::npos)
        << refusal(both);
    EXPECT_NE(refusal(both, {"steel", "brass"}), "");
}

TEST(SolidMsh, RoundingOffThePlaneIsNone) {
    EXPECT_EQ(refusal(with("2 1 0\n$EndNodes", "2 1 -1e-11\n$EndNodes")), "");
    EXPECT_NE(refusal(with("2 1 0\n$EndNodes", "2 1 -1e-8\n$EndNodes")), "");
}

TEST(SolidMsh, OnePartMakesABodyOfItsOwn) {
    const Mesh mesh = read(two_squares(), {"brass"});
    EXPECT_NO_THROW(check_mesh(mesh));
    EXPECT_NEAR(mesh_area(mesh), 1, 1e-15);
    BodyConfig body;
    body.name = "plate";
    body.mesh = mesh;
    BoundaryCondition condition;
    condition.name = "side";
    condition.curve = "joint"; // now on the boundary
    EXPECT_EQ(edges_of(condition, body, boundary_edges(mesh)).size(), 1u);
    condition.curve = "clamp"; // on the other body
    EXPECT_THROW(edges_of(condition, body, boundary_edges(mesh)), std::invalid_argument);
}

TEST(SolidMsh, EachFaultIsToldWithItsLine) {
    const auto expect = [](const std::string& fault, const std::string& words) {
        EXPECT_NE(fault.find(words), std::string::npos) << fault;
    };
    expect(refusal(with("4.1 0 8", "2.2 0 8")), "two.msh, line 2: the mesh is of version 2.2");
    expect(refusal(with("4.1 0 8", "4.1 1 8")), "binary");
    expect(refusal("solid ascii\n"), "line 1: 'solid' stands outside any section");
    expect(refusal("$Nodes\n"), "starts with $MeshFormat");
    expect(refusal(with("2 1 2 2\n4 1 2 5", "2 1 3 1\n4 1 2 5 4")), "line 46: elements of type 3");
    expect(refusal(with("2 1 2 2\n4 1 2 5", "2 1 9 2\n4 1 2 5")), "first order");
    expect(refusal(with("6 2 6 3", "6 2 6 8")), "node 8");
    expect(refusal(with("2 1 0\n$EndNodes", "2 1 0.5\n$EndNodes")), "lies at z = 0.5");
    expect(refusal(with("2 1 0\n$EndNodes", "2 one 0\n$EndNodes")), "line 36: the line should");
    expect(refusal(with("$EndElements\n", "")), "ends within the section $Elements");
    expect(refusal(with("2 2 2 2\n", "2 2 2 1\n")), "where $EndElements should");
    expect(refusal(two_squares(), {"iron"}), "no physical surface 'iron'; it has brass, steel");
}

TEST(SolidMsh, MeshesThatCannotBeComputedAreRefusedByTheBody) {
    const auto refused = [](const std::string& text) -> std::string {
        BodyConfig body;
        body.name = "plate";
        body.mesh = read(text);
        try {
            Body{body};
        } catch (const std::invalid_argument& fault) {
            return fault.what();
        }
        return "";
    };
    EXPECT_EQ(refused(two_squares()), "");
    EXPECT_NE(refused(with("5 1 5 4", "5 1 4 5")).find("inverted"), std::string::npos);
    EXPECT_NE(refused(with("1 0 0\n2 0 0", "0 0 0\n2 0 0")).find("no area"), std::string::npos);
}

TEST(SolidMsh, GeometryIsMeshedByGmsh) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "solid_gmsh";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const auto write = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder / name) << text;
        return folder / name;
    };
    const auto plate = write("plate.geo", R"(SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 4, 2}; Disk(2) = {2, 1, 0, 0.5};
BooleanDifference(3) = {Surface{1}; Delete;}{Surface{2}; Delete;};
Physical Surface("plate") = {3};
)");
    if (std::system("command -v gmsh > /dev/null") != 0) {
        try {
            read_mesh_file(plate, {}, 0.2, folder / "made");
            FAIL() << "meshed without gmsh";
        } catch (const std::invalid_argument& fault) {
            EXPECT_NE(std::string(fault.what()).find("install it"), std::string::npos);
        }
        return;
    }
    const Mesh mesh = read_mesh_file(plate, {"plate"}, 0.2, folder / "made");
    EXPECT_NO_THROW(check_mesh(mesh));
    // A polygon of about sixteen sides is 2.6 % smaller than its circle.
    EXPECT_NEAR(mesh_area(mesh), 8 - std::numbers::pi / 4, 0.03 * std::numbers::pi / 4);
    const auto broken = write("broken.geo", "Line(1) = {1, 2};\n");
    try {
        read_mesh_file(broken, {}, 0, folder / "made");
        FAIL() << "meshed";
    } catch (const std::invalid_argument& fault) {
        EXPECT_NE(std::string(fault.what()).find("gmsh could not mesh"), std::string::npos);
        EXPECT_NE(std::string(fault.what()).find("Error"), std::string::npos) << fault.what();
    }
}

TEST(SolidShapes, DiscAndRingCoverTheirAreas) {
    const Mesh disc = disc_mesh({1, 2}, 0.5, 0.05);
    EXPECT_NO_THROW(check_mesh(disc));
    const double sixty = 60 * 0.5 * std::sin(2 * std::numbers::pi / 60) * 0.25; // its polygon
    EXPECT_NEAR(mesh_area(disc), sixty, 1e-14);
    EXPECT_EQ(boundary_edges(disc).size(), 60u);
    EXPECT_EQ(disc.curve.at(0).edge.size(), 60u);

    const Mesh ring = ring_mesh({1, 2}, 0.2, 0.3, 0.1 / 3);
    EXPECT_NO_THROW(check_mesh(ring));
    EXPECT_EQ(ring.node.size(), 4u * 47); // 3 cells across, 2 pi 0.25 / 0.0333 round
    const double sector = 0.5 * 47 * std::sin(2 * std::numbers::pi / 47);
    EXPECT_NEAR(mesh_area(ring), sector * (0.09 - 0.04), 1e-14);
    EXPECT_EQ(boundary_edges(ring).size(), 2u * 47);
    EXPECT_THROW(ring_mesh({0, 0}, 2, 1, 0.1), std::invalid_argument);
    EXPECT_THROW(disc_mesh({0, 0}, 0, 0.1), std::invalid_argument);
}

TEST(SolidShapes, WhatCannotBeMeshedIsToldBeforeItIsTried) {
    const auto refusal = [](const auto& make) -> std::string {
        try {
            check_mesh(make());
        } catch (const std::invalid_argument& fault) {
            return fault.what();
        }
        return "";
    };
    const auto expect = [](const std::string& fault, const std::string& words) {
        EXPECT_NE(fault.find(words), std::string::npos) << fault;
    };
    // 65536 x 65536 cells would wrap round to none in 32 bits.
    expect(refusal([] { return rectangle_mesh({0, 0}, 1, 1, 1.0 / 65536); }), "4.29497e+09 cells");
    expect(refusal([] { return disc_mesh({0, 0}, 1, 1e-5); }), "make it larger");
    expect(refusal([] { return ring_mesh({0, 0}, 0.5, 1, 1e-5); }), "make it larger");
    // Sixteen elements round: arcs 1 - cos(pi/16) = 0.019 high.
    const auto ring = [](double thickness, double size) {
        return [=] { return ring_mesh({0, 0}, 1 - thickness, 1, size); };
    };
    expect(refusal(ring(0.018, 0.39)), "make the element size smaller than 0.37");
    EXPECT_EQ(refusal(ring(0.018, 0.37)), "");
    EXPECT_EQ(refusal(ring(0.021, 0.39)), "");
}

} // namespace
} // namespace duet::solid
