// A series of snapshots in time: an HDF5 file beside an XDMF file that ParaView opens.
//
// `stem`.h5 shows the frames as groups; their data lie in `stem`_frames/, a file each, which is
// written once and closed before anything leads to it. `stem`.h5 and `stem`.xdmf are written aside
// and renamed with each frame. So the series is valid after every append, also when the process is
// killed, and other programs may read it while it grows. (HDF5 cannot do this within one file: a
// new link changes several blocks of it, and a kill between two of them leaves a torn file.)
//
// In the files plane vectors and positions carry a zero as third component: ParaView then draws
// points and arrows without a filter. A mesh equal to the last frame's is linked, not written
// again. Both indices are rewritten whole with each frame, about 1 kB a frame: meant for hundreds
// of frames.

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace duet::snapshot {

enum class Cell { vertex, triangle };

/// Values of one field; components = 1 (scalar), 2 (plane vector, stored with a zero third), 3
/// (vector) or 6 (symmetric tensor xx, xy, xz, yy, yz, zz). `per_cell`: one entry a cell instead of
/// one a point.
struct Field {
    std::string name;
    int components = 1;
    std::span<const double> values; ///< [entries][components]
    bool per_cell = false;
};

struct Frame {
    double time = 0;                  ///< s
    std::span<const double> position; ///< [points][2] m, the same or moved points, any number
    std::span<const std::uint32_t> connectivity; ///< [cells][3] for triangles; empty for vertices
    std::vector<Field> fields;
};

class Series {
  public:
    /// Creates `stem`.h5, replacing an earlier series and removing `stem`.xdmf, which comes with
    /// the first frame; throws std::runtime_error naming the path and the reason. `attributes`
    /// (e.g. title, version, units) are stored on the root group.
    Series(const std::filesystem::path& stem,
           Cell cell,
           const std::map<std::string, std::string>& attributes = {});
    ~Series();
    Series(Series&&) noexcept;
    Series& operator=(Series&&) noexcept;

    /// Appends group /frame_000000 ... with attribute `time` (s) and data sets `position`
    /// [points][3], `connectivity` [cells][1 or 3] (vertices: 0, 1, ...), and one a field
    /// ([entries] or [entries][components]). ParaView wants the frames in the order of time. Throws
    /// std::invalid_argument if sizes or names do not fit, std::runtime_error naming the path and
    /// the reason if it cannot be written.
    void append(const Frame& frame);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace duet::snapshot
