// A series of snapshots in time, in one HDF5 file beside an XDMF file that ParaView opens.
//
// The file is valid after every append: HDF5 is flushed first, then the XDMF is written aside and
// renamed.

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

/// Values of one field; components = 1 (scalar), 2 (vector, stored as given), 3 or more (tensor
/// components, each by name in docs). `per_cell`: one entry a cell instead of one a point.
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
    /// Creates `stem`.h5 and `stem`.xdmf (replacing both); throws std::runtime_error naming the
    /// path and the reason. `attributes` (e.g. title, version, units) are stored on the root group.
    Series(const std::filesystem::path& stem,
           Cell cell,
           const std::map<std::string, std::string>& attributes = {});
    ~Series();
    Series(Series&&) noexcept;
    Series& operator=(Series&&) noexcept;

    /// Appends group /frame_000000 ... with datasets `position` [points][2], `connectivity`, and
    /// one a field.
    void append(const Frame& frame);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace duet::snapshot
