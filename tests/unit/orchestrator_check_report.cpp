// What `duet check` says that it will model.

#include "orchestrator/case_file.hpp"
#include "orchestrator/check_report.hpp"

#include <gtest/gtest.h>

namespace duet::orchestrator {
namespace {

TEST(CheckReport, AWallThatSlipsIsSaidToSlipOnce) {
    const Case given = parse_case(R"(
[time]
end = 1

[fluid]
spacing = 0.1
region = [[0, 0], [4, 0], [4, 4], [0, 4]]
density = 1
kinematic_viscosity = 1

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

} // namespace
} // namespace duet::orchestrator
