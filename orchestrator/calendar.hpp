// When windows end: the marks of a run (probes, snapshots, checks, the end), and the cutting of the
// time between them into windows.

#pragma once

#include "duet/v1/coupling.pb.h"

#include <cstdint>
#include <vector>

namespace duet::orchestrator {

/// A time at which something is recorded.
struct Mark {
    double time = 0; ///< s
    bool sample = false;
    bool snapshot = false;
};

/// All marks after the start, ascending; the last one is the end, where everything is recorded.
std::vector<Mark> marks_of(const v1::Scene& scene);

/// Cuts the run into leases.
class Calendar {
  public:
    explicit Calendar(const v1::Scene& scene);

    bool done() const { return next_mark_ == marks_.size(); }

    /// The next lease: `most` windows at most, each no longer than `stable` (s; 0: no limit but a
    /// hundredth of the run) or, if the case fixes it, than time.window; of equal length up to the
    /// next mark, where a window always ends exactly. Throws std::runtime_error if the windows
    /// become hopelessly many.
    v1::Lease next(double stable, std::uint32_t most);

  private:
    std::vector<Mark> marks_;
    std::size_t next_mark_ = 0;
    double fixed_window_ = 0;
    double time_ = 0;
    std::uint64_t window_ = 0;
};

} // namespace duet::orchestrator
