// The cavity: region, holes, and walls.

#include "orchestrator/scene_checker.hpp"

#include "fluid_solver/scattered_state.hpp"
#include "protocol/function.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace duet::orchestrator {

using protocol::is_zero;

void Checker::check_fluid() {
    check_initial_state();
    if (scene_.fluid().fourth_order() && scene_.fluid().formulation() == v1::Fluid::PAPER)
        problem("fluid.fourth_order",
                "the paper's formulation has no Laplacian of fourth order; take the consistent "
                "one, or leave fluid.fourth_order away");
    const std::string path = "fluid.region";
    if (scene_.fluid().has_disc() == (scene_.fluid().region_size() > 0))
        return problem("fluid",
                       "[fluid] needs either 'region', the corners of the cavity, or 'disc'");
    if (const auto fault = polygon_fault(region_, tolerance_))
        return problem(path, "fluid.region is no simple polygon: " + *fault);
    if (area(region_) <= tolerance_ * extent(region_))
        return problem(path, "fluid.region encloses no area");
    region_good_ = true;
    if (scene_.fluid().spacing() > extent(region_) / 2)
        problem("fluid.spacing", "fluid.spacing is more than half the extent of the region");
    check_periodic();
    check_size(particles_of(scene_), "fluid particles", "fluid.spacing");
    check_names("fluid.hole", scene_.fluid().hole());
    for (int i = 0; i < scene_.fluid().hole_size(); ++i)
        check_hole(scene_.fluid().hole(i), entry("fluid.hole", i));
    check_names("fluid.wall", scene_.fluid().wall());
    for (int i = 0; i < scene_.fluid().wall_size(); ++i)
        check_wall(scene_.fluid().wall(i), entry("fluid.wall", i));
}

/// One period is a rectangle, and long enough that no particle sees another one twice.
void Checker::check_periodic() {
    const auto [along_x, along_y] = periodic(scene_.fluid());
    if (!along_x && !along_y)
        return;
    double left = region_[0].x(), right = left, low = region_[0].y(), high = low;
    for (const Point& p : region_) {
        left = std::min(left, p.x());
        right = std::max(right, p.x());
        low = std::min(low, p.y());
        high = std::max(high, p.y());
    }
    if (std::abs((right - left) * (high - low) - area(region_)) > tolerance_ * extent(region_)) {
        region_good_ = false;
        return problem("fluid.periodic",
                       "a periodic fluid needs a rectangle along the axes as its region; give "
                       "fluid.region the corners of one period");
    }
    constexpr double shortest = 6; // spacings: a particle sees 2.6 to either side
    const double least = shortest * scene_.fluid().spacing() * (1 - 1e-9);
    if ((along_x && right - left < least) || (along_y && high - low < least))
        problem("fluid.spacing",
                "one period of the fluid is shorter than six spacings; refine fluid.spacing, or "
                "take several periods as fluid.region");
}

/// A body is moved over a periodic side by the run alone: at the start it lies within one period.
void Checker::check_clear_of_seams(const v1::Body& body, const std::string& path) {
    Polygon places = outline(body);
    if (mesh_.contains(&body))
        for (const solid::Point& p : mesh_.at(&body).node)
            places.push_back(point(p.x(), p.y()));
    for (const Piece& seam : seams(scene_.fluid(), tolerance_))
        for (const Point& p : places)
            if (on_piece(p, seam.first, seam.second, tolerance_))
                return problem(path,
                               "the body '" + body.name()
                                   + "' reaches the periodic side of "
                                     "fluid.region at "
                                   + at_text(p)
                                   + "; move it off, or let another part of the fluid be the "
                                     "period");
}

/// Whether the wall is none of the sides over which the fluid is periodic.
bool Checker::check_seams(const v1::Wall& wall, const std::string& path) {
    const std::vector<Piece> sides = seams(scene_.fluid(), tolerance_);
    if (wall.around() == "region" && !sides.empty()) {
        problem(path + ".around",
                "the wall '" + wall.name()
                    + "' goes round a region that is periodic; name by 'along' the sides that are "
                      "walls");
        return false;
    }
    for (const Piece& side : sides)
        if (wall.along_size() == 2
            && common_length(wall.along(0), wall.along(1), side.first, side.second, tolerance_)
                   > tolerance_) {
            problem(path + ".along",
                    "the wall '" + wall.name() + "' lies on the side from " + at_text(side.first)
                        + " to " + at_text(side.second)
                        + ", over which the fluid is periodic; leave it out, or change "
                          "fluid.periodic");
            return false;
        }
    return true;
}

/// The fluid will be able to read it.
void Checker::check_initial_state() {
    const std::string& file = scene_.fluid().initial_state();
    if (file.empty())
        return;
    try {
        fluid::ScatteredState{file};
    } catch (const std::invalid_argument& error) {
        problem("fluid.initial_state", error.what());
    }
}

void Checker::check_hole(const v1::Hole& hole, const std::string& path) {
    if (hole.has_disc() == (hole.corners_size() > 0))
        return problem(path, path + " needs either 'corners' or 'disc'");
    if (hole.name() == "region")
        problem(path + ".name", "the name 'region' stands for the cavity itself; take another");
    const Polygon polygon = outline(hole);
    if (const auto fault = polygon_fault(polygon, tolerance_))
        return problem(path + ".corners", path + ".corners is no simple polygon: " + *fault);
    const bool within = std::all_of(polygon.begin(), polygon.end(), [&](const Point& p) {
        return inside(region_, p, tolerance_) && !on_boundary(region_, p, tolerance_);
    });
    if (!within)
        problem(path,
                "the hole '" + hole.name()
                    + "' reaches the boundary of the cavity; move it inside, or give the region "
                      "the corners of what is left");
    for (const v1::Hole& other : scene_.fluid().hole()) {
        if (&other == &hole)
            break;
        if (meet(polygon, outline(other), tolerance_))
            problem(path,
                    "the holes '" + other.name() + "' and '" + hole.name()
                        + "' meet; make one polygon of them, or move them apart");
    }
    for (const v1::Body& body : scene_.solid().body())
        if (overlap(polygon, outline(body), tolerance_))
            problem(path,
                    "the hole '" + hole.name() + "' and the body '" + body.name()
                        + "' overlap; a body lies in the fluid, or leans on a wall");
}

void Checker::check_wall(const v1::Wall& wall, const std::string& path) {
    if (!check_seams(wall, path))
        return;
    if (wall.has_temperature() && !is_zero(wall.heat_flux()))
        problem(path + ".temperature",
                path + " prescribes a temperature and a heat flux; keep one of them");
    else if (scene_.fluid().conductivity() == 0
             && (wall.has_temperature() || !is_zero(wall.heat_flux())))
        problem(path,
                "a fluid without 'conductivity' takes no heat from the wall '" + wall.name()
                    + "'; give fluid.conductivity, or leave the wall's heat out");
    if (wall.has_rotation())
        steady_in_place(wall.rotation().rate(), path + ".rotation.rate");
    check_sharing(wall, path);
    check_slip(wall, path);
    if (wall.around().empty() == (wall.along_size() == 0))
        return problem(path, path + " needs either 'along', two points, or 'around', a hole");
    if (!wall.around().empty()) {
        if (wall.around() != "region")
            must_be_known(wall.around(), "hole", scene_.fluid().hole(), path + ".around");
        return;
    }
    const Point& a = wall.along(0);
    const Point& b = wall.along(1);
    if (distance(a, b) <= tolerance_)
        return problem(path + ".along", path + ".along needs two different points");
    int sides = 0;
    const auto count = [&](const Polygon& polygon) {
        for (std::size_t i = 0; i < polygon.size(); ++i)
            sides += on_piece(polygon[i], a, b, tolerance_)
                     && on_piece(polygon[(i + 1) % polygon.size()], a, b, tolerance_);
    };
    count(region_);
    for (const v1::Hole& hole : scene_.fluid().hole())
        count(outline(hole));
    if (sides == 0)
        problem(path + ".along",
                "no side of fluid.region lies between " + at_text(a) + " and " + at_text(b)
                    + "; give the two ends of a side");
    const Point velocity = point(wall.velocity().x().number(), wall.velocity().y().number());
    const double across = (b.x() - a.x()) * velocity.y() - (b.y() - a.y()) * velocity.x();
    const double speed = distance(point(0, 0), velocity);
    if (std::abs(across) > 1e-9 * speed * distance(a, b))
        problem(path + ".velocity", "a wall of a closed cavity can only move along itself");
}

/// What a wall lies around.
Polygon Checker::outline_of(const std::string& around) const {
    if (around == "region")
        return region_;
    for (const v1::Hole& hole : scene_.fluid().hole())
        if (hole.name() == around)
            return outline(hole);
    return Polygon{};
}

/// Along an axis each component of the velocity has one condition.
void Checker::check_slip(const v1::Wall& wall, const std::string& path) {
    if (!wall.slip())
        return;
    if (scene_.fluid().formulation() == v1::Fluid::PAPER)
        problem(path + ".slip",
                "the paper's formulation knows no walls that slip; take the consistent one");
    if (wall.has_rotation() || !is_zero(wall.velocity()))
        problem(path + ".slip",
                "a wall that slips moves nothing along itself; give it no velocity");
    const Polygon sides =
        wall.along_size() == 2 ? Polygon{wall.along(0), wall.along(1)} : outline_of(wall.around());
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const Point &a = sides[i], &b = sides[(i + 1) % sides.size()];
        if (std::min(std::abs(a.x() - b.x()), std::abs(a.y() - b.y())) > tolerance_) {
            problem(path + ".slip",
                    "the wall '" + wall.name() + "' slips from " + at_text(a) + " to " + at_text(b)
                        + ", which is not along an axis; turn the scene, or let it not slip");
            return;
        }
    }
}

/// No side belongs to two walls.
void Checker::check_sharing(const v1::Wall& wall, const std::string& path) {
    const auto on = [&](const Polygon& polygon, const v1::Wall& one) {
        double length = 0;
        for (std::size_t i = 0; i < polygon.size(); ++i)
            length += common_length(one.along(0),
                                    one.along(1),
                                    polygon[i],
                                    polygon[(i + 1) % polygon.size()],
                                    tolerance_);
        return length > tolerance_;
    };
    for (const v1::Wall& other : scene_.fluid().wall()) {
        if (&other == &wall)
            return;
        const bool lines = wall.along_size() == 2 && other.along_size() == 2;
        const bool loops = !wall.around().empty() && !other.around().empty();
        const bool shared =
            lines ? common_length(
                        wall.along(0), wall.along(1), other.along(0), other.along(1), tolerance_)
                        > tolerance_
            : loops ? wall.around() == other.around()
            : wall.along_size() == 2
                ? on(outline_of(other.around()), wall)
                : other.along_size() == 2 && on(outline_of(wall.around()), other);
        if (shared)
            problem(path,
                    "the walls '" + other.name() + "' and '" + wall.name() + "' share a side");
    }
}

} // namespace duet::orchestrator
