// The text of an XDMF 3 file: a temporal collection of uniform grids whose numbers lie in an HDF5
// file beside it. https://www.xdmf.org/index.php/XDMF_Model_and_Format

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace duet::snapshot {

/// One data set as XDMF refers to it.
struct XdmfArray {
    std::string name;
    std::size_t entries = 0;
    std::size_t components = 1;
    bool per_cell = false;
};

/// One point in time. All arrays lie in the HDF5 group /`group`; beside the fields these are
/// `position` [points][3] and `connectivity` [cells][nodes_per_cell].
struct XdmfGrid {
    std::string group;
    double time = 0; ///< s
    std::string topology;
    std::size_t points = 0;
    std::size_t cells = 0;
    std::size_t nodes_per_cell = 0;
    std::vector<XdmfArray> fields;
};

/// A number in the shortest decimal form that reads back to the same bits.
std::string shortest(double value);

/// The <Grid> element of one point in time; `data_file` is the HDF5 file's name without folders.
std::string xdmf_grid(const XdmfGrid& grid, const std::string& data_file);

/// The whole file round the grids' elements.
std::string xdmf_document(const std::string& name, const std::string& grids);

/// Writes `text` aside and renames it to `path`, so that a reader sees the old or the new file and
/// never a part. Throws std::runtime_error with the path and the system's reason.
void replace_file(const std::filesystem::path& path, const std::string& text);

} // namespace duet::snapshot
