// `duet sweep`: a case run for every combination of listed values, each held against its checks.

#pragma once

#include "orchestrator/verify.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace duet::orchestrator {

/// One combination: the overrides that make it, the varied ones by key and value apart.
struct Variant {
    std::vector<std::string> overrides; ///< "fluid.spacing=0.2", as read_case() takes them
    std::vector<std::pair<std::string, std::string>> varied; ///< key, value as TOML text
};

/// The product of all lists among the overrides, the last one changing fastest. A list stands where
/// the key takes one value: fluid.spacing=[0.2, 0.1], gravity=[[0, -10], [0, -5]]; overrides of
/// single values belong to every variant. Throws std::invalid_argument with a sentence.
std::vector<Variant> variants_of(const std::vector<std::string>& overrides);

/// A variant and what came of it.
struct Trial {
    Variant variant;
    RunResult result;
    std::vector<Verdict> verdicts; ///< empty if the run did not finish
};

/// One line a trial: the varied keys, the error of each check, CPU seconds and steps of each
/// process, wall seconds, how it ended, revision.
std::string sweep_csv(const std::vector<Trial>& trials);
std::string sweep_json(const Case& given, const std::vector<Trial>& trials);

} // namespace duet::orchestrator
