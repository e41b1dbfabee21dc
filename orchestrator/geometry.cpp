#include "orchestrator/geometry.hpp"

#include "orchestrator/mesh_body.hpp"

#include <algorithm>
#include <cmath>

namespace duet::orchestrator {

namespace {

/// Twice the area of the triangle a, b, c; positive if they run counter-clockwise.
double cross(const Point& a, const Point& b, const Point& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

double dot(const Point& a, const Point& b, const Point& c) {
    return (b.x() - a.x()) * (c.x() - a.x()) + (b.y() - a.y()) * (c.y() - a.y());
}

double distance_to_line(const Point& p, const Point& a, const Point& b) {
    return std::abs(cross(a, b, p)) / distance(a, b);
}

/// The open pieces cross in one point, each end more than tolerance off the other's line.
bool crosses(const Point& a, const Point& b, const Point& c, const Point& d, double tolerance) {
    const auto apart = [&](const Point& from, const Point& to, const Point& p, const Point& q) {
        return cross(from, to, p) * cross(from, to, q) < 0
               && distance_to_line(p, from, to) > tolerance
               && distance_to_line(q, from, to) > tolerance;
    };
    return apart(a, b, c, d) && apart(c, d, a, b);
}

bool sides_cross(const Polygon& a, const Polygon& b, double tolerance) {
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j)
            if (crosses(a[i], a[(i + 1) % a.size()], b[j], b[(j + 1) % b.size()], tolerance))
                return true;
    return false;
}

std::string corner_name(std::size_t i) {
    return "corner [" + std::to_string(i) + "]";
}

} // namespace

Point point(double x, double y) {
    Point p;
    p.set_x(x);
    p.set_y(y);
    return p;
}

double distance(const Point& a, const Point& b) {
    return std::hypot(b.x() - a.x(), b.y() - a.y());
}

Polygon corners(const v1::Rectangle& r) {
    const double x = r.corner().x();
    const double y = r.corner().y();
    return {point(x, y),
            point(x + r.width(), y),
            point(x + r.width(), y + r.height()),
            point(x, y + r.height())};
}

double area(const Polygon& polygon) {
    double twice = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        twice += cross(polygon[0], polygon[i], polygon[i + 1]);
    return std::abs(twice) / 2;
}

Polygon corners(const v1::Disc& disc) {
    constexpr int count = 720;
    Polygon polygon;
    for (int i = 0; i < count; ++i) {
        const double phi = 2 * std::acos(-1.0) * i / count;
        polygon.push_back(point(disc.centre().x() + disc.radius() * std::cos(phi),
                                disc.centre().y() + disc.radius() * std::sin(phi)));
    }
    return polygon;
}

Polygon outline(const v1::Fluid& fluid) {
    if (fluid.has_disc())
        return corners(fluid.disc());
    return {fluid.region().begin(), fluid.region().end()};
}

std::pair<bool, bool> periodic(const v1::Fluid& fluid) {
    const auto p = fluid.periodic();
    return {p == v1::Fluid::X || p == v1::Fluid::BOTH, p == v1::Fluid::Y || p == v1::Fluid::BOTH};
}

std::vector<Piece> seams(const v1::Fluid& fluid, double tolerance) {
    const auto [along_x, along_y] = periodic(fluid);
    const Polygon region = outline(fluid);
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < region.size(); ++i) {
        const Point &a = region[i], &b = region[(i + 1) % region.size()];
        if ((along_x && std::abs(a.x() - b.x()) <= tolerance)
            || (along_y && std::abs(a.y() - b.y()) <= tolerance))
            pieces.push_back({a, b});
    }
    return pieces;
}

Polygon outline(const v1::Hole& hole) {
    if (hole.has_disc())
        return corners(hole.disc());
    return {hole.corners().begin(), hole.corners().end()};
}

Polygon outline(const v1::Body& body) {
    if (body.has_rectangle())
        return corners(body.rectangle());
    if (body.has_disc())
        return corners(body.disc());
    if (!body.has_ring())
        return {};
    v1::Disc disc;
    *disc.mutable_centre() = body.ring().centre();
    disc.set_radius(body.ring().outer_radius());
    return corners(disc);
}

double area_of(const v1::Body& body) {
    const double pi = std::acos(-1.0);
    if (body.has_rectangle())
        return body.rectangle().width() * body.rectangle().height();
    if (const auto mesh = mesh_of(body))
        return solid::mesh_area(*mesh);
    const double outer = body.has_disc() ? body.disc().radius() : body.ring().outer_radius();
    return pi * (outer * outer - body.ring().inner_radius() * body.ring().inner_radius());
}

/// Nodes of a body; a triangulation has one for each square of the elements' size.
double nodes_of(const v1::Body& body) {
    if (const auto mesh = mesh_of(body))
        return static_cast<double>(mesh->node.size());
    if (!body.has_rectangle())
        return body.element_size() > 0 ? area_of(body) / (body.element_size() * body.element_size())
                                       : 0;
    const double across = std::max(1.0, std::round(body.rectangle().width() / body.element_size()));
    const double up = std::max(1.0, std::round(body.rectangle().height() / body.element_size()));
    return (across + 1) * (up + 1);
}

double solid_area(const v1::Scene& scene) {
    double sum = 0;
    for (const v1::Body& body : scene.solid().body())
        sum += area_of(body);
    return sum;
}

double particles_of(const v1::Scene& scene) {
    const auto& fluid = scene.fluid();
    double room = area(outline(fluid)) - solid_area(scene);
    for (const v1::Hole& hole : fluid.hole())
        room -= area(outline(hole));
    return room / (fluid.spacing() * fluid.spacing());
}

double extent(const Polygon& polygon) {
    const auto by_x = [](const Point& a, const Point& b) { return a.x() < b.x(); };
    const auto by_y = [](const Point& a, const Point& b) { return a.y() < b.y(); };
    const auto [left, right] = std::minmax_element(polygon.begin(), polygon.end(), by_x);
    const auto [low, high] = std::minmax_element(polygon.begin(), polygon.end(), by_y);
    return std::max(right->x() - left->x(), high->y() - low->y());
}

std::optional<std::string> polygon_fault(const Polygon& polygon, double tolerance) {
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i)
        if (distance(polygon[i], polygon[(i + 1) % n]) <= tolerance)
            return corner_name(i) + " and " + corner_name((i + 1) % n)
                   + " coincide; a polygon closes by itself";
    for (std::size_t i = 0; i < n; ++i) {
        const Point& before = polygon[(i + n - 1) % n];
        const Point& after = polygon[(i + 1) % n];
        if (distance_to_line(polygon[i], before, after) <= tolerance
            && dot(polygon[i], before, after) > 0)
            return "the boundary turns back on itself at " + corner_name(i);
        for (std::size_t j = 0; j < n; ++j)
            if (j != i && (j + 1) % n != i
                && on_piece(polygon[i], polygon[j], polygon[(j + 1) % n], tolerance))
                return corner_name(i) + " lies on the side from " + corner_name(j) + " to "
                       + corner_name((j + 1) % n);
        for (std::size_t j = i + 2; j < n; ++j)
            if (crosses(polygon[i], after, polygon[j], polygon[(j + 1) % n], tolerance))
                return "the side from " + corner_name(i) + " crosses the side from "
                       + corner_name(j);
    }
    return std::nullopt;
}

bool on_piece(const Point& p, const Point& a, const Point& b, double tolerance) {
    const double length = distance(a, b);
    const double along = dot(a, b, p) / length;
    return distance_to_line(p, a, b) <= tolerance && along >= -tolerance
           && along <= length + tolerance;
}

bool inside(const Polygon& polygon, const Point& p, double tolerance) {
    bool odd = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point& a = polygon[i];
        const Point& b = polygon[(i + 1) % polygon.size()];
        if (on_piece(p, a, b, tolerance))
            return true;
        if ((a.y() > p.y()) != (b.y() > p.y())
            && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
            odd = !odd;
    }
    return odd;
}

bool strictly_inside(const v1::Rectangle& r, const Point& p, double tolerance) {
    return p.x() > r.corner().x() + tolerance && p.x() < r.corner().x() + r.width() - tolerance
           && p.y() > r.corner().y() + tolerance && p.y() < r.corner().y() + r.height() - tolerance;
}

namespace {

/// The piece a-b passes through the rectangle's interior: clipped by the four sides (Liang and
/// Barsky), something remains.
bool enters(const v1::Rectangle& r, const Point& a, const Point& b, double tolerance) {
    double first = 0;
    double last = 1;
    const auto clip = [&](double start, double direction, double low, double high) {
        if (direction == 0)
            return start > low && start < high;
        const double t0 = (low - start) / direction;
        const double t1 = (high - start) / direction;
        first = std::max(first, std::min(t0, t1));
        last = std::min(last, std::max(t0, t1));
        return first < last;
    };
    const double x = r.corner().x();
    const double y = r.corner().y();
    return clip(a.x(), b.x() - a.x(), x + tolerance, x + r.width() - tolerance)
           && clip(a.y(), b.y() - a.y(), y + tolerance, y + r.height() - tolerance);
}

} // namespace

bool rectangle_inside(const v1::Rectangle& rectangle, const Polygon& polygon, double tolerance) {
    for (const Point& corner : corners(rectangle))
        if (!inside(polygon, corner, tolerance))
            return false;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        if (enters(rectangle, polygon[i], polygon[(i + 1) % polygon.size()], tolerance))
            return false;
    return true;
}

bool on_boundary(const Polygon& polygon, const Point& p, double tolerance) {
    for (std::size_t i = 0; i < polygon.size(); ++i)
        if (on_piece(p, polygon[i], polygon[(i + 1) % polygon.size()], tolerance))
            return true;
    return false;
}

bool overlap(const Polygon& a, const Polygon& b, double tolerance) {
    const auto holds = [&](const Polygon& polygon, const Polygon& corners) {
        return std::any_of(corners.begin(), corners.end(), [&](const Point& p) {
            return inside(polygon, p, tolerance) && !on_boundary(polygon, p, tolerance);
        });
    };
    return holds(a, b) || holds(b, a) || sides_cross(a, b, tolerance);
}

bool meet(const Polygon& a, const Polygon& b, double tolerance) {
    const auto holds = [&](const Polygon& polygon, const Polygon& corners) {
        return std::any_of(corners.begin(), corners.end(), [&](const Point& p) {
            return inside(polygon, p, tolerance);
        });
    };
    return holds(a, b) || holds(b, a) || sides_cross(a, b, tolerance);
}

bool overlap(const v1::Rectangle& a, const v1::Rectangle& b, double tolerance) {
    const double x = std::min(a.corner().x() + a.width(), b.corner().x() + b.width())
                     - std::max(a.corner().x(), b.corner().x());
    const double y = std::min(a.corner().y() + a.height(), b.corner().y() + b.height())
                     - std::max(a.corner().y(), b.corner().y());
    return x > tolerance && y > tolerance;
}

std::optional<Piece>
common_piece(const Point& a, const Point& b, const Point& c, const Point& d, double tolerance) {
    const double length = distance(a, b);
    if (length <= tolerance || distance_to_line(c, a, b) > tolerance
        || distance_to_line(d, a, b) > tolerance)
        return std::nullopt;
    const double at_c = dot(a, b, c) / length;
    const double at_d = dot(a, b, d) / length;
    const double from = std::max(0.0, std::min(at_c, at_d)) / length;
    const double to = std::min(length, std::max(at_c, at_d)) / length;
    if (to <= from)
        return std::nullopt;
    const auto at = [&](double s) {
        return point(a.x() + s * (b.x() - a.x()), a.y() + s * (b.y() - a.y()));
    };
    return Piece{at(from), at(to)};
}

double
common_length(const Point& a, const Point& b, const Point& c, const Point& d, double tolerance) {
    const auto piece = common_piece(a, b, c, d, tolerance);
    return piece ? distance(piece->first, piece->second) : 0;
}

} // namespace duet::orchestrator
