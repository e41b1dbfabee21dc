#include "solid_solver/smoothing.hpp"

#include <algorithm>

namespace duet::solid {

namespace {

/// Gradients of the three linear shape functions of a triangle, times its area: the edge opposite
/// node i, turned by a right angle, over two.
std::array<Point, 3> area_times_gradient(const Mesh& mesh, const Triangle& triangle) {
    std::array<Point, 3> result;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point opposite = mesh.node[triangle[(i + 2) % 3]] - mesh.node[triangle[(i + 1) % 3]];
        result[i] = 0.5 * Point(-opposite.y(), opposite.x());
    }
    return result;
}

/// A domain while it is put together from triangles: sums of area-weighted parts.
struct Assembly {
    double area = 0;
    std::size_t count = 0;
    std::array<std::uint32_t, Domains::slots> node{};
    std::array<double, Domains::slots> x{}, y{}, weight{};

    std::size_t slot(std::uint32_t wanted) {
        const auto end = node.begin() + static_cast<std::ptrdiff_t>(count);
        const auto found = std::find(node.begin(), end, wanted);
        if (found == end) {
            node[count++] = wanted;
            return count - 1;
        }
        return static_cast<std::size_t>(found - node.begin());
    }

    /// Adds `share` of a triangle; `mean` are the means of its shape functions over that share.
    void add(const Mesh& mesh,
             const Triangle& triangle,
             double share,
             const std::array<double, 3>& mean) {
        const double part = share * triangle_area(mesh, triangle);
        const std::array<Point, 3> gradient = area_times_gradient(mesh, triangle);
        area += part;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t s = slot(triangle[i]);
            x[s] += share * gradient[i].x();
            y[s] += share * gradient[i].y();
            weight[s] += part * mean[i];
        }
    }

    void finish(std::uint32_t part, Domains& domains) {
        for (std::size_t s = count; s < Domains::slots; ++s) {
            node[s] = node[0];
        }
        for (std::size_t s = 0; s < Domains::slots; ++s) {
            x[s] /= area;
            y[s] /= area;
            weight[s] /= area;
        }
        domains.area.push_back(area);
        domains.node.push_back(node);
        domains.gradient_x.push_back(x);
        domains.gradient_y.push_back(y);
        domains.weight.push_back(weight);
        domains.part.push_back(part);
    }
};

void add_third(const Mesh& mesh, const Edge& edge, std::uint32_t triangle, Assembly& assembly) {
    Triangle corners = mesh.triangle[triangle];
    while (corners[2] == edge.a || corners[2] == edge.b) { // the edge first
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    }
    assembly.add(mesh, corners, 1.0 / 3, {4.0 / 9, 4.0 / 9, 1.0 / 9});
}

void add_edge_domains(const Mesh& mesh, Domains& domains) {
    for (const Edge& edge : mesh_edges(mesh)) {
        Assembly assembly;
        add_third(mesh, edge, edge.triangle[0], assembly);
        const std::uint32_t part = mesh.part_of(edge.triangle[0]);
        if (!edge.boundary()) {
            const std::uint32_t other = mesh.part_of(edge.triangle[1]);
            if (other != part) {
                assembly.finish(part, domains);
                assembly = {};
            }
            add_third(mesh, edge, edge.triangle[1], assembly);
            assembly.finish(other, domains);
        } else {
            assembly.finish(part, domains);
        }
    }
}

void add_element_domains(const Mesh& mesh, Domains& domains) {
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
        Assembly assembly;
        assembly.add(mesh, mesh.triangle[t], 1, {1.0 / 3, 1.0 / 3, 1.0 / 3});
        assembly.finish(mesh.part_of(t), domains);
    }
}

void add_gather(std::size_t nodes, Domains& domains) {
    const auto filled = [&](std::size_t k, std::size_t s) {
        return s == 0 || domains.node[k][s] != domains.node[k][0];
    };
    domains.first.assign(nodes + 1, 0);
    for (std::size_t k = 0; k < domains.size(); ++k) {
        for (std::size_t s = 0; s < Domains::slots; ++s) {
            domains.first[domains.node[k][s] + 1] += filled(k, s);
        }
    }
    for (std::size_t i = 0; i < nodes; ++i) {
        domains.first[i + 1] += domains.first[i];
    }
    domains.entry.resize(domains.first[nodes]);
    std::vector<std::uint32_t> next(domains.first.begin(), domains.first.end() - 1);
    for (std::size_t k = 0; k < domains.size(); ++k) {
        for (std::size_t s = 0; s < Domains::slots; ++s) {
            if (filled(k, s)) {
                domains.entry[next[domains.node[k][s]]++] =
                    static_cast<std::uint32_t>(Domains::slots * k + s);
            }
        }
    }
}

} // namespace

Domains make_domains(const Mesh& mesh, Smoothing smoothing) {
    Domains domains;
    if (smoothing == Smoothing::edge) {
        domains.share = 1.0 / 3;
        add_edge_domains(mesh, domains);
    } else {
        add_element_domains(mesh, domains);
    }
    add_gather(mesh.node.size(), domains);
    return domains;
}

std::vector<double> nodal_area(const Mesh& mesh, const std::vector<double>& density) {
    std::vector<double> area(mesh.node.size(), 0.0);
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
        const double weight = density.empty() ? 1 : density[mesh.part_of(t)];
        const double third = weight * triangle_area(mesh, mesh.triangle[t]) / 3;
        for (const std::uint32_t i : mesh.triangle[t]) {
            area[i] += third;
        }
    }
    return area;
}

} // namespace duet::solid
