// `duet verify`: a run held against the checks of its case.

#pragma once

#include "orchestrator/run.hpp"

#include <string>
#include <vector>

namespace duet::orchestrator {

/// One line of the table.
struct Verdict {
    std::string quantity; ///< with its time: "plate_centre at 2.5 s"
    double value = 0;     ///< of a profile or a history: the mean
    double reference = 0;
    double error = 0;
    double tolerance = 0;
    bool judged = true;
    bool pass = false;
    std::string why;     ///< of the tolerance
    std::string problem; ///< what kept it from being held against its reference
};

/// Holds a finished run against every check of its case.
std::vector<Verdict> judge(const Case& given, const RunResult& result);

/// All judged checks pass, and there is one.
bool all_pass(const std::vector<Verdict>& verdicts);

/// The table for the terminal, with the cost of the run below it.
std::string verdict_table(const std::vector<Verdict>& verdicts, const RunResult& result);

/// case, revision, checks, cpu_seconds, peak_memory_bytes, wall_seconds, balances.
std::string
verdict_json(const Case& given, const std::vector<Verdict>& verdicts, const RunResult& result);

} // namespace duet::orchestrator
