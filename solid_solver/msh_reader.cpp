#include "solid_solver/msh_reader.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace duet::solid {

namespace {

using Tag = long long;
using Entity = std::pair<int, Tag>; ///< dimension and tag: an entity, or a physical group

/// A block of elements of one surface or curve.
struct Block {
    Entity entity;
    int line; ///< where it starts
    std::vector<std::array<Tag, 3>> element;
};

class MshReader {
  public:
    MshReader(std::istream& file, std::string name) : file_(file), name_(std::move(name)) {}

    void read();
    Mesh mesh(const std::vector<std::string>& wanted);

  private:
    [[noreturn]] void fail(const std::string& sentence, int line) const {
        throw std::invalid_argument(name_ + ", line " + std::to_string(line) + ": " + sentence);
    }
    [[noreturn]] void fail(const std::string& sentence) const { fail(sentence, line_); }

    /// The next line that is not empty, as a stream of its words.
    std::istringstream next() {
        std::string text;
        while (std::getline(file_, text)) {
            ++line_;
            if (text.find_first_not_of(" \t\r") != std::string::npos) {
                return std::istringstream(text);
            }
        }
        fail("the file ends within the section $" + section_ + "; write it out anew.");
    }

    template <class... Value>
    void take(std::istringstream& words, const char* what, Value&... value) const {
        if (!(words >> ... >> value)) {
            fail(std::string("the line should give ") + what + ".");
        }
    }

    void read_format();
    void read_names();
    void read_entities();
    void read_nodes();
    void check_plane() const;
    void read_elements();
    void skip();
    void end_section();

    std::vector<std::string> group_names(const Entity& entity) const;
    std::string part_name(const Block& block, const std::vector<std::string>& wanted) const;
    void add_triangles(const Block& block, std::uint32_t part, Mesh& mesh);
    void add_curves(Mesh& mesh) const;
    std::uint32_t node(Tag tag, int line, Mesh& mesh);

    std::istream& file_;
    std::string name_, section_ = "MeshFormat";
    int line_ = 0;
    std::map<Entity, std::string> group_name_;
    std::map<Entity, std::vector<Tag>> groups_of_; ///< the physical groups of an entity
    std::map<Tag, Point> place_;
    struct {
        Tag tag = 0;
        int line = 0;
        double z = 0;
    } highest_; ///< the node farthest off the plane
    std::vector<Block> triangles_, lines_;
    std::map<Tag, std::uint32_t> index_; ///< of the nodes that the mesh uses
};

void MshReader::read() {
    std::string text;
    std::set<std::string> seen;
    while (std::getline(file_, text)) {
        ++line_;
        std::istringstream words(text);
        std::string head;
        if (!(words >> head)) {
            continue;
        }
        if (head[0] != '$') {
            fail("'" + head + "' stands outside any section; this is no Gmsh mesh.");
        }
        section_ = head.substr(1);
        if (section_ != "MeshFormat" && seen.count("MeshFormat") == 0) {
            fail("a Gmsh mesh starts with $MeshFormat, not " + head + ".");
        }
        seen.insert(section_);
        section_ == "MeshFormat"      ? read_format()
        : section_ == "PhysicalNames" ? read_names()
        : section_ == "Entities"      ? read_entities()
        : section_ == "Nodes"         ? read_nodes()
        : section_ == "Elements"      ? read_elements()
                                      : skip();
    }
    for (const char* needed : {"MeshFormat", "Nodes", "Elements"}) {
        if (seen.count(needed) == 0) {
            fail(std::string("the mesh has no section $") + needed + ".");
        }
    }
}

void MshReader::read_format() {
    std::istringstream words = next();
    std::string version;
    int binary = 0;
    take(words, "the format: version, 0 for text, size of a number", version, binary);
    if (version != "4.1") {
        fail("the mesh is of version " + version
             + ", but only 4.1 is read; write it with gmsh -format msh41.");
    }
    if (binary != 0) {
        fail("the mesh is binary, but only text is read; write it without gmsh's -bin.");
    }
    end_section();
}

void MshReader::read_names() {
    int count = 0;
    std::istringstream first = next();
    take(first, "the number of physical names", count);
    for (int i = 0; i < count; ++i) {
        std::istringstream words = next();
        Entity group;
        take(words, "dimension, tag and name of a physical group", group.first, group.second);
        std::string rest;
        std::getline(words, rest);
        const auto open = rest.find('"'), close = rest.rfind('"');
        if (open == std::string::npos || close == open) {
            fail("the name of a physical group stands in double quotes.");
        }
        group_name_[group] = rest.substr(open + 1, close - open - 1);
    }
    end_section();
}

void MshReader::read_entities() {
    std::array<Tag, 4> count{};
    std::istringstream first = next();
    take(first,
         "the numbers of points, curves, surfaces, volumes",
         count[0],
         count[1],
         count[2],
         count[3]);
    for (int dimension = 0; dimension < 4; ++dimension) {
        for (Tag i = 0; i < count[static_cast<std::size_t>(dimension)]; ++i) {
            std::istringstream words = next();
            Tag tag = 0, groups = 0;
            double box = 0;
            take(words, "the tag of an entity", tag);
            for (int n = 0; n < (dimension == 0 ? 3 : 6); ++n) {
                take(words, "the bounding box of an entity", box);
            }
            take(words, "the number of an entity's physical groups", groups);
            for (Tag n = 0; n < groups; ++n) {
                Tag group = 0;
                take(words, "an entity's physical groups", group);
                // The sign tells the direction of travel.
                groups_of_[{dimension, tag}].push_back(group < 0 ? -group : group);
            }
        }
    }
    end_section();
}

void MshReader::read_nodes() {
    Tag blocks = 0;
    std::istringstream first = next();
    take(first, "the number of blocks of nodes", blocks);
    for (Tag b = 0; b < blocks; ++b) {
        Tag dimension = 0, entity = 0, parametric = 0, count = 0;
        std::istringstream head = next();
        take(head,
             "dimension, entity, parametric, number of nodes",
             dimension,
             entity,
             parametric,
             count);
        std::vector<Tag> tags;
        for (Tag i = 0; i < count; ++i) {
            std::istringstream words = next();
            take(words, "the tag of a node", tags.emplace_back());
        }
        for (const Tag tag : tags) {
            std::istringstream words = next();
            double x = 0, y = 0, z = 0;
            take(words, "the coordinates of a node", x, y, z);
            if (std::abs(z) > std::abs(highest_.z)) {
                highest_ = {tag, line_, z};
            }
            if (!place_.emplace(tag, Point(x, y)).second) {
                fail("node " + std::to_string(tag) + " is defined twice.");
            }
        }
    }
    check_plane();
    end_section();
}

/// A program may leave the rounding of its transformations in z.
void MshReader::check_plane() const {
    double extent = 0;
    for (const auto& [tag, place] : place_) {
        extent = std::max(extent, (place - place_.begin()->second).norm());
    }
    if (std::abs(highest_.z) > 1e-10 * extent) {
        std::ostringstream sentence;
        sentence << "node " << highest_.tag << " lies at z = " << highest_.z
                 << "; a mesh of the plane has z = 0 throughout.";
        fail(sentence.str(), highest_.line);
    }
}

void MshReader::read_elements() {
    Tag blocks = 0;
    std::istringstream first = next();
    take(first, "the number of blocks of elements", blocks);
    for (Tag b = 0; b < blocks; ++b) {
        int dimension = 0, type = 0;
        Tag entity = 0, count = 0;
        std::istringstream head = next();
        take(head, "dimension, entity, type, number of elements", dimension, entity, type, count);
        constexpr int line = 1, triangle = 2, point = 15;
        if (type != line && type != triangle && type != point) {
            const bool quadrilateral = type == 3 || type == 10 || type == 16;
            fail("elements of type " + std::to_string(type)
                 + (quadrilateral ? ", quadrilaterals," : "")
                 + " are not read; mesh with triangles of the first order"
                 + (quadrilateral ? ", without recombining." : " (gmsh -order 1)."));
        }
        Block block{{dimension, entity}, line_, {}};
        const int nodes = type == triangle ? 3 : type == line ? 2 : 1;
        for (Tag i = 0; i < count; ++i) {
            std::istringstream words = next();
            Tag tag = 0;
            take(words, "the tag of an element", tag);
            block.element.push_back({});
            for (int n = 0; n < nodes; ++n) {
                take(words,
                     "the nodes of an element",
                     block.element.back()[static_cast<std::size_t>(n)]);
            }
        }
        if (type == triangle) {
            triangles_.push_back(std::move(block));
        } else if (type == line) {
            lines_.push_back(std::move(block));
        }
    }
    end_section();
}

/// Sections that say nothing about a plain mesh: periodicity, partitions, data.
void MshReader::skip() {
    std::string head;
    do {
        next() >> head;
    } while (head != "$End" + section_);
}

void MshReader::end_section() {
    std::string head;
    next() >> head;
    if (head != "$End" + section_) {
        fail("'" + head + "' stands where $End" + section_
             + " should; the section's counts do not "
               "fit its lines.");
    }
}

/// The names of the physical groups that the entity belongs to; a group without one has its tag.
std::vector<std::string> MshReader::group_names(const Entity& entity) const {
    std::vector<std::string> names;
    const auto groups = groups_of_.find(entity);
    if (groups == groups_of_.end()) {
        return names;
    }
    for (const Tag group : groups->second) {
        const auto name = group_name_.find({entity.first, group});
        names.push_back(name == group_name_.end() ? std::to_string(group) : name->second);
    }
    return names;
}

/// The part that a surface belongs to: the one of its groups that is wanted, or the only one; none:
/// "".
std::string MshReader::part_name(const Block& block, const std::vector<std::string>& wanted) const {
    const std::vector<std::string> all = group_names(block.entity);
    std::vector<std::string> chosen;
    for (const std::string& name : all) {
        if (wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end()) {
            chosen.push_back(name);
        }
    }
    if (chosen.size() > 1) {
        fail("the surface " + std::to_string(block.entity.second)
                 + " belongs to several physical groups, '" + chosen[0] + "' and '" + chosen[1]
                 + "' among them; name those that are to be parts of the body.",
             block.line);
    }
    return !chosen.empty() ? chosen[0] : all.empty() ? "" : all[0];
}

std::uint32_t MshReader::node(Tag tag, int line, Mesh& mesh) {
    const auto place = place_.find(tag);
    if (place == place_.end()) {
        fail("an element of this block names node " + std::to_string(tag)
                 + ", which the file does not define.",
             line);
    }
    const auto next = static_cast<std::uint32_t>(mesh.node.size());
    const auto [found, added] = index_.emplace(tag, next);
    if (added) {
        mesh.node.push_back(place->second);
    }
    return found->second;
}

void MshReader::add_triangles(const Block& block, std::uint32_t part, Mesh& mesh) {
    const std::size_t first = mesh.triangle.size();
    double largest = -1;
    for (const auto& element : block.element) {
        mesh.triangle.push_back({node(element[0], block.line, mesh),
                                 node(element[1], block.line, mesh),
                                 node(element[2], block.line, mesh)});
        mesh.part.push_back(part);
        largest = std::max(largest, triangle_area(mesh, mesh.triangle.back()));
    }
    for (std::size_t t = first; largest < 0 && t < mesh.triangle.size(); ++t) {
        std::swap(mesh.triangle[t][1], mesh.triangle[t][2]);
    }
}

void MshReader::add_curves(Mesh& mesh) const {
    std::map<std::string, std::vector<std::array<std::uint32_t, 2>>> curves;
    for (const Block& block : lines_) {
        for (const std::string& name : group_names(block.entity)) {
            for (const auto& element : block.element) {
                const auto a = index_.find(element[0]), b = index_.find(element[1]);
                if (a != index_.end() && b != index_.end()) { // else on another body
                    curves[name].push_back({a->second, b->second});
                }
            }
        }
    }
    for (auto& [name, edge] : curves) {
        mesh.curve.push_back({name, std::move(edge)});
    }
}

Mesh MshReader::mesh(const std::vector<std::string>& wanted) {
    Mesh mesh;
    std::set<std::string> found;
    for (const Block& block : triangles_) {
        const std::string name = part_name(block, wanted);
        found.insert(name);
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) {
            continue;
        }
        auto part = std::find(mesh.part_name.begin(), mesh.part_name.end(), name);
        const auto index = static_cast<std::uint32_t>(part - mesh.part_name.begin());
        if (part == mesh.part_name.end()) {
            mesh.part_name.push_back(name);
        }
        add_triangles(block, index, mesh);
    }
    for (const std::string& name : wanted) {
        if (found.count(name) == 0) {
            std::string names;
            for (const std::string& one : found) {
                names += (names.empty() ? "" : ", ") + (one.empty() ? "one without a name" : one);
            }
            throw std::invalid_argument(
                name_ + " has no physical surface '" + name + "'; "
                + (names.empty() ? "it has no triangles at all." : "it has " + names + "."));
        }
    }
    if (mesh.triangle.empty()) {
        throw std::invalid_argument(name_
                                    + " has no triangles; mesh a surface (gmsh -2), and if "
                                      "it has physical groups, make the surface one.");
    }
    add_curves(mesh);
    return mesh;
}

} // namespace

Mesh read_msh(std::istream& file, const std::string& name, const std::vector<std::string>& parts) {
    MshReader reader(file, name);
    reader.read();
    return reader.mesh(parts);
}

} // namespace duet::solid
