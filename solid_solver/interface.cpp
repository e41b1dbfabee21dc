#include "solid_solver/interface.hpp"

#include "solid_solver/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace duet::solid {

namespace {

struct Outline {
    std::string name;
    const Mesh* mesh = nullptr;
    std::vector<Edge> edges;
    std::vector<Side> sides;
};

std::string place(const Point& p) {
    std::ostringstream text;
    text << '(' << p.x() << ", " << p.y() << ')';
    return text.str();
}

Point middle(const Side& side) {
    return 0.5 * (side.from + side.to);
}

void check_inside(const Outline& body, const std::vector<Side>& region, double tolerance) {
    for (const Side& side : body.sides) {
        for (const Point& p : {side.from, middle(side)}) {
            if (locate(p, region, tolerance) == Where::outside) {
                throw std::invalid_argument("Body '" + body.name + "' leaves the fluid's region at "
                                            + place(p) + "; move it, or make the region larger.");
            }
        }
        for (const Side& wall : region) {
            if (cross(side, wall, tolerance)) {
                throw std::invalid_argument(
                    "Body '" + body.name + "' crosses the boundary of the fluid's region near "
                    + place(middle(side)) + "; move it, or make the region larger.");
            }
        }
    }
}

/// A corner of the region inside an edge would leave half the edge wet.
void check_corners(const Outline& body, const std::vector<Side>& region, double tolerance) {
    for (const Side& side : body.sides) {
        const double length = (side.to - side.from).norm();
        const Point along = (side.to - side.from) / length;
        for (const Side& wall : region) {
            const Point d = wall.from - side.from;
            const double s = d.dot(along);
            const double off = std::abs(d.x() * along.y() - d.y() * along.x());
            if (off <= tolerance && s > tolerance && s < length - tolerance) {
                throw std::invalid_argument(
                    "The region's corner " + place(wall.from) + " lies inside an edge of body '"
                    + body.name + "'; choose its element_size so that a node lies there.");
            }
        }
    }
}

void check_apart(const Outline& a, const Outline& b, double tolerance) {
    const auto fail = [&](const Point& p) {
        throw std::invalid_argument(
            "Bodies '" + a.name + "' and '" + b.name + "' overlap or touch at " + place(p)
            + "; leave room for the fluid between them, or make them one body.");
    };
    for (const Side& side : a.sides) {
        if (locate(side.from, b.sides, tolerance) != Where::outside) {
            fail(side.from);
        }
        for (const Side& other : b.sides) {
            if (cross(side, other, tolerance)) {
                fail(middle(side));
            }
        }
    }
    for (const Side& side : b.sides) {
        if (locate(side.from, a.sides, tolerance) != Where::outside) {
            fail(side.from);
        }
    }
}

/// Puts the wet edges of one body one behind the other.
void add_chains(std::uint32_t body,
                const Outline& outline,
                const std::vector<bool>& wet,
                Interface& result) {
    constexpr std::uint32_t none = Edge::none;
    std::vector<std::uint32_t> next(outline.mesh->node.size(), none);
    std::vector<bool> entered(outline.mesh->node.size(), false);
    for (std::size_t e = 0; e < outline.edges.size(); ++e) {
        if (wet[e]) {
            next[outline.edges[e].a] = outline.edges[e].b;
            entered[outline.edges[e].b] = true;
        }
    }
    const auto follow = [&](std::uint32_t start) {
        Interface::Chain chain;
        std::uint32_t node = start;
        do {
            chain.node.push_back(static_cast<std::uint32_t>(result.node.size()));
            result.node.push_back({body, node});
            const std::uint32_t here = node;
            node = next[here];
            next[here] = none;
        } while (node != none && node != start);
        chain.closed = node == start;
        for (std::size_t j = 0; j < chain.segments(); ++j) {
            result.segment.push_back({chain.node[j], chain.node[(j + 1) % chain.node.size()]});
        }
        result.chain.push_back(std::move(chain));
    };
    for (std::uint32_t i = 0; i < next.size(); ++i) { // open chains start where no edge comes in
        if (next[i] != none && !entered[i]) {
            follow(i);
        }
    }
    for (std::uint32_t i = 0; i < next.size(); ++i) {
        if (next[i] != none) {
            follow(i);
        }
    }
}

} // namespace

Interface wet_interface(const std::vector<BodyShape>& bodies, const std::vector<Point>& region) {
    const std::vector<Side> walls = polygon_sides(region);
    Point low = region.front(), high = low;
    for (const Point& p : region) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const double tolerance = 1e-9 * (high - low).norm(); // rounding of coordinates, nothing else

    std::vector<Outline> outlines;
    for (const BodyShape& body : bodies) {
        Outline outline{body.name, body.mesh, boundary_edges(*body.mesh), {}};
        for (const Edge& edge : outline.edges) {
            outline.sides.push_back({body.place[edge.a], body.place[edge.b]});
        }
        check_inside(outline, walls, tolerance);
        check_corners(outline, walls, tolerance);
        for (const Outline& other : outlines) {
            check_apart(other, outline, tolerance);
        }
        outlines.push_back(std::move(outline));
    }

    Interface result;
    for (std::uint32_t b = 0; b < outlines.size(); ++b) {
        std::vector<bool> wet;
        for (const Side& side : outlines[b].sides) {
            wet.push_back(locate(middle(side), walls, tolerance) == Where::inside);
        }
        add_chains(b, outlines[b], wet, result);
    }
    return result;
}

} // namespace duet::solid
