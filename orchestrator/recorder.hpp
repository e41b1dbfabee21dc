// What a run records beside the solvers' fields: probes.csv, profiles.csv, coupling.h5; and the
// histories that `duet verify` judges.

#pragma once

#include "duet/v1/coupling.pb.h"
#include "orchestrator/run_folder.hpp"

#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace duet::orchestrator {

/// A scalar over time.
struct History {
    std::vector<double> time; ///< s
    std::vector<double> value;
};

/// A field along a line at one time.
struct Profile {
    double time = 0;              ///< s
    std::vector<double> position; ///< m, arc length from the line's first point
    std::vector<double> value;
};

/// A line of which every point is kept.
bool is_profile(const v1::Probe& probe);

class Recorder {
  public:
    /// Creates the files. Throws std::runtime_error naming the file.
    Recorder(const v1::Scene& scene, const RunFolder& folder);
    ~Recorder();

    /// The probes of both sides at one time: one line of probes.csv, and the lines of profiles.csv.
    /// Throws std::runtime_error if a sample is not of the shape that its probe has.
    void record(double time, const std::vector<v1::Sample>& samples);

    /// A copy of what one solver sent to the other.
    void record(const v1::ToPeer& exchange);

    const std::map<std::string, History>& histories() const { return histories_; }
    const std::map<std::string, std::vector<Profile>>& profiles() const { return profiles_; }

  private:
    struct CouplingFile;
    void record_profile(double time, const v1::Sample& sample);

    v1::Scene scene_;
    std::ofstream probes_;
    std::ofstream profile_lines_;
    std::unique_ptr<CouplingFile> coupling_;
    std::map<std::string, History> histories_;
    std::map<std::string, std::vector<Profile>> profiles_;
};

} // namespace duet::orchestrator
