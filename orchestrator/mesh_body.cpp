#include "orchestrator/mesh_body.hpp"

#include "solid_solver/msh_reader.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <stdexcept>

namespace duet::orchestrator {

std::optional<solid::Mesh> mesh_of(const v1::Body& body, std::string* fault) {
    if (!body.mesh().ends_with(".msh"))
        return std::nullopt;
    try {
        std::ifstream file(body.mesh());
        if (!file)
            throw std::invalid_argument("The mesh " + body.mesh() + " cannot be opened.");
        solid::Mesh mesh =
            solid::read_msh(file, body.mesh(), {body.part().begin(), body.part().end()});
        solid::check_mesh(mesh);
        return mesh;
    } catch (const std::invalid_argument& error) {
        if (fault)
            *fault = error.what();
        return std::nullopt;
    }
}

std::vector<std::string> boundary_curves(const solid::Mesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
    for (const solid::Edge& edge : solid::boundary_edges(mesh))
        sides.insert(std::minmax(edge.a, edge.b));
    std::vector<std::string> names;
    for (const solid::Curve& curve : mesh.curve)
        if (std::any_of(curve.edge.begin(), curve.edge.end(), [&](const auto& edge) {
                return sides.contains(std::minmax(edge[0], edge[1]));
            }))
            names.push_back(curve.name);
    return names;
}

} // namespace duet::orchestrator
