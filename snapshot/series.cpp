#include "snapshot/series.hpp"

#include "snapshot/hdf5.hpp"
#include "snapshot/xdmf.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <set>
#include <stdexcept>
#include <system_error>

namespace duet::snapshot {
namespace {

std::size_t nodes_per_cell(Cell cell) {
    return cell == Cell::triangle ? 3 : 1;
}

std::filesystem::path with_suffix(std::filesystem::path stem, const char* suffix) {
    stem += suffix;
    return stem;
}

std::string frame_name(std::size_t index) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%06zu", index);
    return name;
}

/// [entries][2] with a zero as third component, which is what ParaView draws as arrows and points.
std::vector<double> padded(std::span<const double> pairs) {
    std::vector<double> out(pairs.size() / 2 * 3, 0.0);
    for (std::size_t i = 0; i < pairs.size() / 2; ++i) {
        out[3 * i] = pairs[2 * i];
        out[3 * i + 1] = pairs[2 * i + 1];
    }
    return out;
}

[[noreturn]] void refuse(double time, const std::string& what) {
    throw std::invalid_argument("snapshot at t = " + shortest(time) + " s: " + what);
}

void check_mesh(const Frame& frame, Cell cell) {
    const std::size_t points = frame.position.size() / 2;
    if (points == 0 || frame.position.size() % 2 != 0)
        refuse(frame.time, "position must hold the x and y of at least one point");
    if (cell == Cell::vertex && !frame.connectivity.empty())
        refuse(frame.time, "vertices take no connectivity; leave it empty");
    if (cell == Cell::triangle
        && (frame.connectivity.empty() || frame.connectivity.size() % 3 != 0))
        refuse(frame.time, "connectivity must hold the three nodes of at least one triangle");
    if (std::ranges::any_of(frame.connectivity, [&](auto node) { return node >= points; }))
        refuse(frame.time, "connectivity names a node beyond the last point");
}

void check_fields(const Frame& frame, std::size_t points, std::size_t cells) {
    std::set<std::string> names{"position", "connectivity"};
    for (const Field& field : frame.fields) {
        if (field.name.empty() || field.name.find_first_of("/.") != std::string::npos
            || !names.insert(field.name).second)
            refuse(frame.time,
                   "field name '" + field.name
                       + "' is empty, taken, or holds a slash or a full stop");
        if (field.components != 1 && field.components != 2 && field.components != 3
            && field.components != 6)
            refuse(frame.time, "field " + field.name + " must have 1, 2, 3 or 6 components");
        const std::size_t entries = field.per_cell ? cells : points;
        if (field.values.size() != entries * static_cast<std::size_t>(field.components))
            refuse(frame.time,
                   "field " + field.name + " has " + std::to_string(field.values.size())
                       + " values, expected " + std::to_string(entries) + " times "
                       + std::to_string(field.components));
    }
}

XdmfArray write_field(hdf5::Group& group, const Field& field) {
    const auto components = static_cast<std::size_t>(field.components);
    const std::size_t entries = field.values.size() / components;
    if (components == 1) {
        group.write<double>(field.name, field.values, {entries});
        return {field.name, entries, 1, field.per_cell};
    }
    if (components == 2) {
        group.write<double>(field.name, padded(field.values), {entries, 3});
        return {field.name, entries, 3, field.per_cell};
    }
    group.write<double>(field.name, field.values, {entries, components});
    return {field.name, entries, components, field.per_cell};
}

} // namespace

struct Series::State {
    State(Cell cells, std::filesystem::path path, std::map<std::string, std::string> texts)
        : cell(cells), stem(std::move(path)), attributes(std::move(texts)) {}

    void append(const Frame& frame);
    void write_mesh(hdf5::Group& data, const std::string& file, const Frame& frame);
    std::string data_file(const std::string& file) const { return name + "_frames/" + file; }
    void write_index() const;

    Cell cell;
    std::filesystem::path stem;
    std::map<std::string, std::string> attributes;
    std::string name = stem.filename().string();
    std::size_t frames = 0;
    std::string grids; ///< the XDMF text of all frames so far

    // The mesh of the last frame and the files that hold it, so that an unchanged one is stored
    // once.
    std::vector<double> position;            ///< [points][3]
    std::vector<std::uint32_t> connectivity; ///< [cells][nodes_per_cell]
    std::string position_file, connectivity_file;
};

/// Writes the mesh, or links what is the same as in the last frame; `file` is where `data` lies.
void Series::State::write_mesh(hdf5::Group& data, const std::string& file, const Frame& frame) {
    std::vector<double> points = padded(frame.position);
    if (points == position) {
        data.refer("position", position_file, "/position");
    } else {
        position = std::move(points);
        position_file = file;
        data.write<double>("position", position, {position.size() / 3, 3});
    }

    std::vector<std::uint32_t> cells(frame.connectivity.begin(), frame.connectivity.end());
    if (cell == Cell::vertex) {
        cells.resize(position.size() / 3);
        std::iota(cells.begin(), cells.end(), 0U);
    }
    if (cells == connectivity) {
        data.refer("connectivity", connectivity_file, "/connectivity");
    } else {
        connectivity = std::move(cells);
        connectivity_file = file;
        const std::size_t nodes = nodes_per_cell(cell);
        data.write<std::uint32_t>(
            "connectivity", connectivity, {connectivity.size() / nodes, nodes});
    }
}

/// `stem`.h5: the attributes, and each frame by its name.
void Series::State::write_index() const {
    const std::filesystem::path aside = with_suffix(stem, ".h5.new");
    {
        hdf5::File index(aside);
        for (const auto& [key, value] : attributes)
            index.attribute(key, value);
        for (std::size_t frame = 0; frame < frames; ++frame)
            index.refer(frame_name(frame), data_file(frame_name(frame) + ".h5"), "/");
        index.flush();
    }
    std::filesystem::rename(aside, with_suffix(stem, ".h5"));
}

void Series::State::append(const Frame& frame) {
    const std::size_t points = frame.position.size() / 2;
    const std::size_t cells =
        cell == Cell::vertex ? points : frame.connectivity.size() / nodes_per_cell(cell);
    check_mesh(frame, cell);
    check_fields(frame, points, cells);

    XdmfGrid grid{frame_name(frames),
                  frame.time,
                  {},
                  {},
                  {},
                  cell == Cell::vertex ? "Polyvertex" : "Triangle",
                  points,
                  cells,
                  nodes_per_cell(cell),
                  {}};
    const std::string file = grid.name + ".h5";
    {
        hdf5::File data(stem.parent_path() / data_file(file));
        data.attribute("time", frame.time);
        write_mesh(data, file, frame);
        for (const Field& field : frame.fields)
            grid.fields.push_back(write_field(data, field));
        data.flush();
    }

    // The frame is whole before the index names it, and the index before the XDMF leads to it. A
    // writer killed in between leaves the frames before.
    ++frames;
    write_index();
    grid.file = data_file(file);
    grid.position_file = data_file(position_file);
    grid.connectivity_file = data_file(connectivity_file);
    grids += xdmf_grid(grid);
    replace_file(with_suffix(stem, ".xdmf"), xdmf_document(name, grids));
}

Series::Series(const std::filesystem::path& stem,
               Cell cell,
               const std::map<std::string, std::string>& attributes)
    : state_(std::make_unique<State>(cell, stem, attributes)) {
    // An XDMF file from before would point into the new, empty data; and one without a frame makes
    // ParaView crash, so the new one comes with the first frame.
    std::error_code ignored;
    std::filesystem::remove(with_suffix(stem, ".xdmf"), ignored);
    state_->write_index();
    const std::filesystem::path data = stem.parent_path() / state_->data_file({});
    std::filesystem::create_directory(data);
    for (const auto& entry : std::filesystem::directory_iterator(data))
        if (entry.path().filename().string().starts_with("frame_"))
            std::filesystem::remove(entry.path());
}

Series::~Series() = default;
Series::Series(Series&&) noexcept = default;
Series& Series::operator=(Series&&) noexcept = default;

void Series::append(const Frame& frame) {
    state_->append(frame);
}

} // namespace duet::snapshot
