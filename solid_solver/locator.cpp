#include "solid_solver/locator.hpp"

#include <algorithm>

namespace duet::solid {

std::optional<Interpolation> interpolation_at(const Mesh& mesh, const Point& point) {
    constexpr double rounding = -1e-9; // of a shape function, at a point on the boundary
    std::optional<Interpolation> best;
    double best_least = rounding;
    for (const Triangle& triangle : mesh.triangle) {
        Interpolation trial{triangle, {}};
        const double whole = triangle_area(mesh, triangle);
        for (std::size_t i = 0; i < 3; ++i) {
            const Point b = mesh.node[triangle[(i + 1) % 3]] - point;
            const Point c = mesh.node[triangle[(i + 2) % 3]] - point;
            trial.weight[i] = 0.5 * (b.x() * c.y() - b.y() * c.x()) / whole;
        }
        const double least = *std::min_element(trial.weight.begin(), trial.weight.end());
        if (least > best_least) { // between triangles: the one that holds it best
            best_least = least;
            best = trial;
        }
    }
    return best;
}

std::uint32_t nearest_node(const Mesh& mesh, const Point& place) {
    const auto nearer = [&](const Point& a, const Point& b) {
        return (a - place).squaredNorm() < (b - place).squaredNorm();
    };
    return static_cast<std::uint32_t>(std::min_element(mesh.node.begin(), mesh.node.end(), nearer)
                                      - mesh.node.begin());
}

} // namespace duet::solid
