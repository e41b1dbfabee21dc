// A good case, and what is found in it after a change.

#pragma once

#include "orchestrator/scene_check.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace duet::orchestrator::test {

inline const std::string good = R"(
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

/// Every problem of the case, a line each.
inline std::string problems(const std::string& text,
                            const std::vector<std::string>& overrides = {}) {
    try {
        check_scene(parse_case(text, "case.toml", overrides));
    } catch (const CaseError& error) {
        return error.what();
    }
    return "";
}

/// The one fault of the good case with `change` says `part`.
inline void expect_fault(const std::string& change, const std::string& part) {
    const std::string text = problems(good, {change});
    EXPECT_NE(text.find(part), std::string::npos) << change << " gave: " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << change << " gave more: " << text;
}

/// The one fault of the good case with these changes, at the first one; none for an empty sentence.
inline void expect_one(const std::vector<std::string>& changes, const std::string& sentence) {
    EXPECT_EQ(problems(good, changes),
              sentence.empty() ? "" : "--set " + changes[0] + ": " + sentence);
}

} // namespace duet::orchestrator::test
