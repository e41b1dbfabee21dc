#include "solid_solver/polygon.hpp"

#include <algorithm>

namespace duet::solid {

namespace {

double distance(const Side& s, const Point& p) {
    const Point d = s.to - s.from;
    const double along = std::clamp((p - s.from).dot(d) / d.squaredNorm(), 0.0, 1.0);
    return (p - s.from - along * d).norm();
}

} // namespace

double offset(const Side& side, const Point& point) {
    const Point d = side.to - side.from, q = point - side.from;
    return (d.x() * q.y() - d.y() * q.x()) / d.norm();
}

Where locate(const Point& point, const std::vector<Side>& sides, double tolerance) {
    bool inside = false;
    for (const Side& side : sides) {
        if (distance(side, point) <= tolerance) {
            return Where::boundary;
        }
        // A ray to the right crosses the loop an odd number of times from within.
        if ((side.from.y() > point.y()) != (side.to.y() > point.y())) {
            const double share = (point.y() - side.from.y()) / (side.to.y() - side.from.y());
            inside ^= point.x() < side.from.x() + share * (side.to.x() - side.from.x());
        }
    }
    return inside ? Where::inside : Where::outside;
}

bool cross(const Side& s, const Side& t, double tolerance) {
    const auto apart = [&](double a, double b) {
        return (a > tolerance && b < -tolerance) || (a < -tolerance && b > tolerance);
    };
    return apart(offset(s, t.from), offset(s, t.to)) && apart(offset(t, s.from), offset(t, s.to));
}

std::vector<Side> polygon_sides(const std::vector<Point>& corners) {
    std::vector<Side> sides;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        sides.push_back({corners[i], corners[(i + 1) % corners.size()]});
    }
    return sides;
}

} // namespace duet::solid
