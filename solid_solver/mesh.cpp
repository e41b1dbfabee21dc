#include "solid_solver/mesh.hpp"

#include "solid_solver/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace duet::solid {

namespace {

[[noreturn]] void refuse(const std::ostringstream& sentence) {
    throw std::invalid_argument(sentence.str());
}

std::string place(const Point& point) {
    std::ostringstream text;
    text << '(' << point.x() << ", " << point.y() << ')';
    return text.str();
}

/// One side of a triangle, as met when walking round it.
struct Walk {
    std::uint32_t low, high, triangle;
    bool forward; ///< walked from low to high
};

std::vector<Walk> sorted_sides(const Mesh& mesh) {
    std::vector<Walk> sides;
    sides.reserve(3 * mesh.triangle.size());
    for (std::uint32_t e = 0; e < mesh.triangle.size(); ++e) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = mesh.triangle[e][i], b = mesh.triangle[e][(i + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), e, a < b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Walk& s, const Walk& t) {
        return std::tie(s.low, s.high, s.triangle) < std::tie(t.low, t.high, t.triangle);
    });
    return sides;
}

void check_triangles(const Mesh& mesh) {
    if (mesh.triangle.empty()) {
        throw std::invalid_argument("The mesh has no triangles.");
    }
    std::vector<bool> used(mesh.node.size(), false);
    for (std::size_t e = 0; e < mesh.triangle.size(); ++e) {
        double longest = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = mesh.triangle[e][i];
            if (a >= mesh.node.size()) {
                std::ostringstream sentence;
                sentence << "Triangle " << e << " names node " << a << ", but the mesh has only "
                         << mesh.node.size() << " nodes.";
                refuse(sentence);
            }
            used[a] = true;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const Point side =
                mesh.node[mesh.triangle[e][(i + 1) % 3]] - mesh.node[mesh.triangle[e][i]];
            longest = std::max(longest, side.squaredNorm());
        }
        // Below this the area is lost in the rounding of the coordinates.
        if (!(triangle_area(mesh, mesh.triangle[e]) > 1e-12 * longest)) {
            std::ostringstream sentence;
            sentence << "Triangle " << e << " at " << place(mesh.node[mesh.triangle[e][0]])
                     << " is inverted or has no area; its nodes must run counter-clockwise.";
            refuse(sentence);
        }
    }
    for (std::size_t i = 0; i < mesh.node.size(); ++i) {
        if (!used[i] || !mesh.node[i].allFinite()) {
            std::ostringstream sentence;
            sentence << "Node " << i << " at " << place(mesh.node[i])
                     << (used[i] ? " is not a finite place."
                                 : " belongs to no triangle; remove it.");
            refuse(sentence);
        }
    }
}

void check_duplicates(const Mesh& mesh, double tolerance) {
    std::vector<std::uint32_t> order(mesh.node.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return mesh.node[a].x() < mesh.node[b].x();
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Point& p = mesh.node[order[i]];
        for (std::size_t j = i + 1; j < order.size(); ++j) {
            const Point& q = mesh.node[order[j]];
            if (q.x() - p.x() > tolerance) {
                break;
            }
            if (std::abs(q.y() - p.y()) <= tolerance) {
                std::ostringstream sentence;
                sentence << "Nodes " << order[i] << " and " << order[j] << " lie in the same place "
                         << place(p) << "; merge them.";
                refuse(sentence);
            }
        }
    }
}

void check_edges(const Mesh& mesh) {
    const std::vector<Walk> sides = sorted_sides(mesh);
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        const Walk &s = sides[i], &t = sides[i + 1];
        if (s.low == t.low && s.high == t.high && s.forward == t.forward) {
            std::ostringstream sentence;
            sentence << "Triangles " << s.triangle << " and " << t.triangle
                     << " lie on the same side of their common edge from "
                     << place(mesh.node[s.low]) << " to " << place(mesh.node[s.high])
                     << "; an edge may have one triangle on either side.";
            refuse(sentence);
        }
    }
}

/// Each boundary node has one boundary edge in and one out, and lies on no other boundary edge.
void check_boundary(const Mesh& mesh, double tolerance) {
    const std::vector<Edge> boundary = boundary_edges(mesh);
    std::vector<std::uint32_t> order;
    for (const Edge& edge : boundary) {
        order.push_back(edge.a);
    }
    const auto before = [&](std::uint32_t i, double x) { return mesh.node[i].x() < x; };
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
        return mesh.node[i].x() < mesh.node[j].x();
    });
    for (const Edge& edge : boundary) {
        const Point &a = mesh.node[edge.a], &b = mesh.node[edge.b];
        const Point along = (b - a).normalized();
        const double length = (b - a).norm();
        auto i = std::lower_bound(
            order.begin(), order.end(), std::min(a.x(), b.x()) - tolerance, before);
        for (; i != order.end() && mesh.node[*i].x() <= std::max(a.x(), b.x()) + tolerance; ++i) {
            const Point from_a = mesh.node[*i] - a;
            const double s = from_a.dot(along);
            const double off = std::abs(from_a.x() * along.y() - from_a.y() * along.x());
            if (s > tolerance && s < length - tolerance && off < tolerance) {
                std::ostringstream sentence;
                sentence << "Node " << *i << " at " << place(mesh.node[*i])
                         << " hangs on the edge from " << place(a) << " to " << place(b)
                         << "; split the triangle behind that edge.";
                refuse(sentence);
            }
        }
    }
    std::vector<bool> left(mesh.node.size(), false);
    for (const Edge& edge : boundary) {
        if (left[edge.a]) {
            std::ostringstream sentence;
            sentence << "The boundary meets itself in node " << edge.a << " at "
                     << place(mesh.node[edge.a]) << "; two triangles must share an edge there.";
            refuse(sentence);
        }
        left[edge.a] = true;
    }
}

/// No piece lies over another one: boundary edges do not cross, and no triangle holds a loop of the
/// boundary (one node of each tells, as the loops do not cross).
void check_overlap(const Mesh& mesh, double tolerance) {
    const auto fail = [](const Point& p) {
        throw std::invalid_argument("The mesh lies twofold at " + place(p)
                                    + "; its surfaces overlap without having nodes in common.");
    };
    std::vector<Edge> boundary = boundary_edges(mesh);
    const auto side = [&](const Edge& e) { return Side{mesh.node[e.a], mesh.node[e.b]}; };
    const auto left = [&](const Edge& e) {
        return std::min(mesh.node[e.a].x(), mesh.node[e.b].x());
    };
    std::vector<std::uint32_t> next(mesh.node.size(), Edge::none);
    for (const Edge& edge : boundary) {
        next[edge.a] = edge.b;
    }
    std::sort(boundary.begin(), boundary.end(), [&](const Edge& e, const Edge& f) {
        return left(e) < left(f);
    });
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        const Side s = side(boundary[i]);
        const double right = std::max(s.from.x(), s.to.x());
        for (std::size_t j = i + 1; j < boundary.size() && left(boundary[j]) <= right; ++j) {
            if (cross(s, side(boundary[j]), tolerance)) {
                fail(0.5 * (s.from + s.to));
            }
        }
    }
    for (const Edge& edge : boundary) {
        if (next[edge.a] == Edge::none) {
            continue; // a loop that has been looked at
        }
        for (const Triangle& t : mesh.triangle) {
            const bool own = t[0] == edge.a || t[1] == edge.a || t[2] == edge.a;
            const Point& p = mesh.node[edge.a];
            double least = std::numeric_limits<double>::infinity(); // distance from the sides
            for (std::size_t i = 0; i < 3; ++i) {
                least = std::min(least, offset({mesh.node[t[i]], mesh.node[t[(i + 1) % 3]]}, p));
            }
            if (!own && least > -tolerance) {
                fail(p);
            }
        }
        for (std::uint32_t i = edge.a; next[i] != Edge::none;) {
            i = std::exchange(next[i], Edge::none);
        }
    }
}

} // namespace

void check_mesh(const Mesh& mesh) {
    check_triangles(mesh);
    Point low = mesh.node.front(), high = low;
    for (const Point& p : mesh.node) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const double tolerance = 1e-10 * (high - low).norm(); // far below any edge that makes sense
    check_duplicates(mesh, tolerance);
    check_edges(mesh);
    check_boundary(mesh, tolerance);
    check_overlap(mesh, tolerance);
}

std::vector<Edge> mesh_edges(const Mesh& mesh) {
    const std::vector<Walk> sides = sorted_sides(mesh);
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const Walk& s = sides[i];
        Edge edge;
        edge.a = s.forward ? s.low : s.high;
        edge.b = s.forward ? s.high : s.low;
        edge.triangle[0] = s.triangle;
        if (i + 1 < sides.size() && sides[i + 1].low == s.low && sides[i + 1].high == s.high) {
            edge.triangle[1] = sides[++i].triangle;
        }
        edges.push_back(edge);
    }
    return edges;
}

std::vector<Edge> boundary_edges(const Mesh& mesh) {
    std::vector<Edge> edges = mesh_edges(mesh);
    std::erase_if(edges, [](const Edge& edge) { return !edge.boundary(); });
    return edges;
}

double triangle_area(const Mesh& mesh, const Triangle& triangle) {
    const Point ab = mesh.node[triangle[1]] - mesh.node[triangle[0]];
    const Point ac = mesh.node[triangle[2]] - mesh.node[triangle[0]];
    return 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
}

double mesh_area(const Mesh& mesh) {
    double area = 0;
    for (const Triangle& triangle : mesh.triangle) {
        area += triangle_area(mesh, triangle);
    }
    return area;
}

} // namespace duet::solid
