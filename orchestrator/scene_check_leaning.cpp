// Bodies that lean on the cavity's walls. The fluid ends where they begin, and it has no particles
// for a gap that opens: so they must stay on their walls.

#include "orchestrator/scene_checker.hpp"

#include "protocol/function.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace duet::orchestrator {

using protocol::is_zero;

namespace {

/// A straight part of a body's outline, and the curves of the body's shape that hold it.
struct Side {
    Point a, b;
    std::vector<std::string> curve;
};

std::vector<Side> sides_of(const v1::Rectangle& rectangle) {
    const Polygon p = corners(rectangle);
    return {{p[0], p[1], {"bottom"}},
            {p[1], p[2], {"right"}},
            {p[2], p[3], {"top"}},
            {p[3], p[0], {"left"}}};
}

std::vector<Side> sides_of(const solid::Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::string>> curves;
    for (const solid::Curve& curve : mesh.curve)
        for (const auto& edge : curve.edge)
            curves[std::minmax(edge[0], edge[1])].push_back(curve.name);
    const auto node = [&](std::uint32_t i) { return point(mesh.node[i].x(), mesh.node[i].y()); };
    std::vector<Side> sides;
    for (const solid::Edge& edge : solid::boundary_edges(mesh))
        sides.push_back({node(edge.a), node(edge.b), curves[std::minmax(edge.a, edge.b)]});
    return sides;
}

/// The sides at the start: a prescribed motion may begin elsewhere than the body is drawn. Throws
/// std::runtime_error if a formula has no value then.
std::vector<Side> at_start(const v1::Body& body, std::vector<Side> sides) {
    if (body.motion() != v1::Body::PRESCRIBED)
        return sides;
    const auto start = [](const v1::Function& f) { return protocol::Function(f)(0, 0, 0); };
    const double right = start(body.displacement().x()), up = start(body.displacement().y());
    const double c = std::cos(start(body.angle())), s = std::sin(start(body.angle()));
    const auto place = [&](Point& p) {
        const double x = p.x() - body.centre().x(), y = p.y() - body.centre().y();
        p = point(body.centre().x() + right + c * x - s * y,
                  body.centre().y() + up + s * x + c * y);
    };
    for (Side& side : sides) {
        place(side.a);
        place(side.b);
    }
    return sides;
}

/// A side of a body that lies on a wall, and the motions that lead off it.
struct Leaning {
    Side side;
    Piece piece; ///< on the wall
    std::string wall;
    bool along_x, along_y;
};

/// The boundaries of a deformable body tell the motion of the whole piece.
bool told(const v1::Body& body, const Leaning& leaning, bool along_x, double tolerance) {
    const auto& [a, b] = leaning.piece;
    const std::vector<std::string>& curves = leaning.side.curve;
    double length = 0;
    for (const v1::Boundary& boundary : body.boundary()) {
        if (!tells_motion(boundary, along_x))
            continue;
        if (std::find(curves.begin(), curves.end(), boundary.curve()) != curves.end())
            return true;
        if (boundary.along_size() == 2)
            length += common_length(boundary.along(0), boundary.along(1), a, b, tolerance);
    }
    return length >= distance(a, b) - 2 * tolerance;
}

/// The keys that would keep the body there and are not given; of a prescribed motion those that may
/// take it off.
std::vector<std::string>
keys_at_fault(const v1::Body& body, const Leaning& leaning, double tolerance) {
    std::vector<std::string> keys;
    const auto add = [&](bool fault, const char* key) {
        if (fault)
            keys.push_back(key);
    };
    const auto moves = [](const v1::Function& f) {
        return protocol::Function(f).depends_on_time();
    };
    const v1::Support& support = body.support();
    switch (body.motion()) {
    case v1::Body::PRESCRIBED:
        add(leaning.along_x && moves(body.displacement().x()), "displacement along x");
        add(leaning.along_y && moves(body.displacement().y()), "displacement along y");
        add(moves(body.angle()), "angle");
        break;
    case v1::Body::RIGID:
        add(leaning.along_x && !support.fixed_x() && !support.has_pivot(), "fixed_x");
        add(leaning.along_y && !support.fixed_y() && !support.has_pivot(), "fixed_y");
        add(!support.fixed_angle(), "fixed_angle");
        break;
    case v1::Body::DEFORMABLE:
        add(leaning.along_x && !told(body, leaning, true, tolerance), "fixed_x");
        add(leaning.along_y && !told(body, leaning, false, tolerance), "fixed_y");
        break;
    default: // at rest
        break;
    }
    return keys;
}

std::string remedy(const v1::Body& body, const std::string& keys) {
    switch (body.motion()) {
    case v1::Body::PRESCRIBED:
        return "its motion may take it off; keep its " + keys + " constant";
    case v1::Body::RIGID:
        return "may leave it; give its support " + keys;
    default:
        return "may leave it; hold what leans there by a boundary with " + keys;
    }
}

/// Those of the sides that lie on the polygon.
void add_leanings(const std::vector<Side>& sides,
                  const Polygon& polygon,
                  const std::string& wall,
                  double tolerance,
                  std::vector<Leaning>& leanings) {
    for (const Side& side : sides) {
        const Point &a = side.a, &b = side.b;
        for (std::size_t i = 0; i < polygon.size(); ++i)
            if (const auto piece =
                    common_piece(polygon[i], polygon[(i + 1) % polygon.size()], a, b, tolerance);
                piece && distance(piece->first, piece->second) > tolerance)
                leanings.push_back({side,
                                    *piece,
                                    wall,
                                    std::abs(b.y() - a.y()) > tolerance,
                                    std::abs(b.x() - a.x()) > tolerance});
    }
}

} // namespace

/// A body that leans on a wall does not leave it. What a .geo file makes is the solid's to check,
/// and so is a deformable body that starts displaced.
void Checker::check_leaning(const v1::Body& body, const std::string& path) {
    if (!region_good_ || body.motion() == v1::Body::FIXED || !is_zero(body.initial_displacement()))
        return;
    std::vector<Side> sides;
    if (body.has_rectangle())
        sides = sides_of(body.rectangle());
    else if (mesh_.contains(&body))
        sides = sides_of(mesh_.at(&body));
    try {
        sides = at_start(body, std::move(sides));
    } catch (const std::runtime_error& error) {
        return problem(path + ".motion",
                       "the body '" + body.name() + "' has no place at the start: " + error.what());
    }
    std::vector<Leaning> leanings;
    add_leanings(sides, region_, "the cavity's wall", tolerance_, leanings);
    for (const v1::Hole& hole : scene_.fluid().hole())
        add_leanings(sides,
                     outline(hole),
                     "the wall of the hole '" + hole.name() + "'",
                     tolerance_,
                     leanings);
    const Leaning* first = nullptr;
    std::vector<std::string> keys;
    for (const Leaning& leaning : leanings)
        for (const std::string& key : keys_at_fault(body, leaning, tolerance_)) {
            first = first ? first : &leaning;
            if (std::find(keys.begin(), keys.end(), key) == keys.end())
                keys.push_back(key);
        }
    if (first)
        problem(path + ".motion",
                "the body '" + body.name() + "' leans on " + first->wall + " from "
                    + at_text(first->piece.first) + " to " + at_text(first->piece.second) + " and "
                    + remedy(body, list(keys, "and")) + ", or move the body away from the wall");
}

} // namespace duet::orchestrator
