// What `duet check` says that it will model.

#include "orchestrator/case_file.hpp"
#include "orchestrator/check_report.hpp"

#include <gtest/gtest.h>

namespace duet::orchestrator {
namespace {

const std::string cavity = R"([time]
end = 1

[fluid]
spacing = 0.1
region = [[0, 0], [4, 0], [4, 4], [0, 4]]
density = 1
kinematic_viscosity = 1
)";

TEST(CheckReport, AWallThatSlipsIsSaidToSlipOnce) {
    const Case given = parse_case(cavity + R"(
[[fluid.wall]]
name = "top"
along = [[0, 4], [4, 4]]
slip = true
temperature = 300

[[fluid.wall]]
name = "floor"
along = [[0, 0], [4, 0]]
)",
                                  "case.toml");
    const std::string report = check_report(given, 1);
    EXPECT_NE(report.find("        wall 'top': 300 K, slips\n"
                          "        wall 'floor': adiabatic\n"
                          "        all other walls: fixed, no-slip, adiabatic\n"),
              std::string::npos)
        << report;
    EXPECT_EQ(report.find("slips"), report.rfind("slips")) << report;
}

TEST(CheckReport, PeriodicDirectionsAreSaid) {
    const auto report = [&](const std::string& periodic) {
        return check_report(
            parse_case(cavity, "case.toml", {"fluid.periodic=\"" + periodic + "\""}), 1);
    };
    EXPECT_EQ(report("none").find("periodic"), std::string::npos);
    EXPECT_NE(
        report("y").find("periodic along y: the region is one period\n        all other walls"),
        std::string::npos);
    EXPECT_NE(report("both").find("periodic along x and y"), std::string::npos);
    EXPECT_EQ(report("both").find("walls"), std::string::npos) << "there are none";
}

} // namespace
} // namespace duet::orchestrator
