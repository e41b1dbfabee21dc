// The text of an XDMF 3 file: a temporal collection of uniform grids whose numbers lie in HDF5
// files. https://www.xdmf.org/index.php/XDMF_Model_and_Format

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

/// One point in time. The fields lie at the root of the HDF5 file `file`, the mesh in `position` of
/// `position_file` [points][3] and `connectivity` of `connectivity_file` [cells][nodes_per_cell].
/// Files are named from the folder of the XDMF.
struct XdmfGrid {
    std::string name;
    double time = 0; ///< s
    std::string file;
    std::string position_file;
    std::string connectivity_file;
    std::string topology;
    std::size_t points = 0;
    std::size_t cells = 0;
    std::size_t nodes_per_cell = 0;
    std::vector<XdmfArray> fields;
};

/// A number in the shortest decimal form that reads back to the same bits.
std::string shortest(double value);

/// The <Grid> element of one point in time.
std::string xdmf_grid(const XdmfGrid& grid);

/// The whole file round the grids' elements.
std::string xdmf_document(const std::string& name, const std::string& grids);

/// Writes `text` aside and renames it to `path`, so that a reader sees the old or the new file and
/// never a part. Throws std::runtime_error with the path and the system's reason.
void replace_file(const std::filesystem::path& path, const std::string& text);

} // namespace duet::snapshot
