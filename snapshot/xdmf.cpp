#include "snapshot/xdmf.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace duet::snapshot {
namespace {

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        default:
            out += c;
        }
    }
    return out;
}

std::string attribute_type(std::size_t components) {
    switch (components) {
    case 1:
        return "Scalar";
    case 3:
        return "Vector";
    default:
        return "Tensor6";
    }
}

/// A <DataItem> that points into the HDF5 file.
std::string data_item(const std::string& place,
                      std::size_t entries,
                      std::size_t components,
                      const std::string& number) {
    std::string shape = std::to_string(entries);
    if (components > 1)
        shape.append(" ").append(std::to_string(components));
    return "<DataItem Dimensions=\"" + shape + "\" " + number + " Format=\"HDF\">" + escaped(place)
           + "</DataItem>\n";
}

} // namespace

std::string shortest(double value) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
}

std::string xdmf_grid(const XdmfGrid& grid) {
    const std::string real = "NumberType=\"Float\" Precision=\"8\"";
    const std::string natural = "NumberType=\"UInt\" Precision=\"4\"";
    std::string text = "<Grid Name=\"" + grid.name + "\" GridType=\"Uniform\">\n<Time Value=\""
                       + shortest(grid.time) + "\"/>\n";
    text += "<Topology TopologyType=\"" + grid.topology + "\" NumberOfElements=\""
            + std::to_string(grid.cells) + "\" NodesPerElement=\""
            + std::to_string(grid.nodes_per_cell) + "\">\n"
            + data_item(
                grid.connectivity_file + ":/connectivity", grid.cells, grid.nodes_per_cell, natural)
            + "</Topology>\n";
    text += "<Geometry GeometryType=\"XYZ\">\n"
            + data_item(grid.position_file + ":/position", grid.points, 3, real) + "</Geometry>\n";
    for (const XdmfArray& field : grid.fields) {
        text += "<Attribute Name=\"" + escaped(field.name) + "\" AttributeType=\""
                + attribute_type(field.components) + "\" Center=\""
                + (field.per_cell ? "Cell" : "Node") + "\">\n"
                + data_item(grid.file + ":/" + field.name, field.entries, field.components, real)
                + "</Attribute>\n";
    }
    return text + "</Grid>\n";
}

std::string xdmf_document(const std::string& name, const std::string& grids) {
    return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n"
           "<Grid Name=\""
           + escaped(name) + "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n" + grids
           + "</Grid>\n</Domain>\n</Xdmf>\n";
}

void replace_file(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::path aside = path;
    aside += ".new";
    errno = 0;
    std::ofstream file(aside, std::ios::binary);
    file << text;
    file.close();
    if (!file)
        throw std::runtime_error("cannot write " + aside.string() + ": "
                                 + (errno ? std::strerror(errno) : "unknown reason"));
    std::error_code error;
    std::filesystem::rename(aside, path, error);
    if (error)
        throw std::runtime_error("cannot rename " + aside.string() + " to " + path.string() + ": "
                                 + error.message());
}

} // namespace duet::snapshot
