// The bodies: shapes, motion, boundaries, point loads.

#include "orchestrator/scene_checker.hpp"

#include "orchestrator/mesh_body.hpp"
#include "orchestrator/schema.hpp"
#include "protocol/function.hpp"

#include <algorithm>

namespace duet::orchestrator {

using protocol::is_zero;

bool tells_motion(const v1::Boundary& boundary, bool along_x) {
    return along_x
               ? boundary.fixed_x() || boundary.has_displacement_x() || boundary.has_velocity_x()
               : boundary.fixed_y() || boundary.has_displacement_y() || boundary.has_velocity_y();
}

void Checker::check_bodies() {
    const auto& bodies = scene_.solid().body();
    check_names("solid.body", bodies);
    for (int i = 0; i < bodies.size(); ++i) {
        check_body(bodies.Get(i), entry("solid.body", i));
        for (int j = 0; j < i; ++j)
            if (bodies.Get(i).has_rectangle() && bodies.Get(j).has_rectangle()
                && overlap(bodies.Get(i).rectangle(), bodies.Get(j).rectangle(), tolerance_))
                problem(entry("solid.body", i) + ".rectangle",
                        "the bodies '" + bodies.Get(j).name() + "' and '" + bodies.Get(i).name()
                            + "' overlap");
    }
}

void Checker::check_body(const v1::Body& body, const std::string& path) {
    check_shape(body, path);
    const bool loaded = body.motion() == v1::Body::DEFORMABLE || body.motion() == v1::Body::RIGID;
    if (!loaded && !is_zero(body.initial_velocity()))
        problem(path + ".initial_velocity",
                "only a body with motion = \"deformable\" or \"rigid\" has an initial velocity; a "
                "prescribed motion has that of its displacement");
    if (body.motion() != v1::Body::DEFORMABLE && !is_zero(body.initial_displacement()))
        problem(path + ".initial_displacement",
                "only a body with motion = \"deformable\" has an initial displacement; put the "
                "body where it starts");
    if (!loaded && body.point_load_size() > 0)
        problem(path + ".point_load",
                "only a body with motion = \"deformable\" or \"rigid\" takes point loads");
    const v1::Support& support = body.support();
    const bool supported = support.fixed_x() || support.fixed_y() || support.fixed_angle()
                           || support.spring_x() > 0 || support.spring_y() > 0
                           || support.spring_angle() > 0 || support.has_pivot();
    if (supported && body.motion() != v1::Body::RIGID)
        problem(path + ".support",
                "only a body with motion = \"rigid\" has a support; hold a deformable one by its "
                "boundaries");
    check_motion(body, path);
    if (body.motion() == v1::Body::DEFORMABLE && !body.has_youngs_modulus())
        problem(path, "the deformable body '" + body.name() + "' lacks the key 'youngs_modulus'");
    check_size(nodes_of(body), "nodes of the body '" + body.name() + "'", path + ".element_size");
    check_leaning(body, path);
    check_point_loads(body, path);
    check_names(path + ".boundary", body.boundary());
    for (int i = 0; i < body.boundary_size(); ++i)
        check_boundary(body.boundary(i), body, entry(path + ".boundary", i));
}

/// Keys that say how a body moves go with the way in which it does.
void Checker::check_motion(const v1::Body& body, const std::string& path) {
    const bool deformable = body.motion() == v1::Body::DEFORMABLE;
    if (body.motion() == v1::Body::PRESCRIBED) {
        steady_in_place(body.displacement().x(), path + ".displacement");
        steady_in_place(body.displacement().y(), path + ".displacement");
        steady_in_place(body.angle(), path + ".angle");
    } else if (!is_zero(body.displacement()) || !is_zero(body.angle())) {
        problem(path, "displacement and angle move a body with motion = \"prescribed\" alone");
    }
    const bool equilibrium = body.start() == v1::Body::EQUILIBRIUM;
    if (equilibrium && !deformable)
        problem(path + ".start", "only a body with motion = \"deformable\" starts in equilibrium");
    if (equilibrium && deformable && !is_zero(body.initial_velocity()))
        problem(
            path + ".initial_velocity",
            "a body that starts in equilibrium is at rest; leave initial_velocity or start out");
    if (body.implicit_step() > 0 && body.stepping() == v1::Body::EXPLICIT)
        problem(path + ".implicit_step",
                "steps are explicit; give stepping = \"implicit\" or \"automatic\" with it");
    if (deformable && !body.has_reference_temperature() && !body.initial_temperature().has_number())
        problem(path + ".initial_temperature",
                "the deformable body '" + body.name()
                    + "' starts at a temperature that is no number; give reference_temperature, at "
                      "which it is free of thermal stress");
}

void Checker::check_point_loads(const v1::Body& body, const std::string& path) {
    check_names(path + ".point_load", body.point_load());
    const Polygon room = outline(body);
    for (int i = 0; i < body.point_load_size(); ++i) {
        const Point& at = body.point_load(i).at();
        if (!room.empty() && !inside(room, at, tolerance_))
            problem(entry(path + ".point_load", i) + ".at",
                    "the point " + at_text(at) + " lies outside the body '" + body.name() + "'");
    }
}

/// A body has one shape, with what belongs to it. What a .geo file makes is the solid's to check.
void Checker::check_shape(const v1::Body& body, const std::string& path) {
    const std::string& mesh = body.mesh();
    const int shapes = body.has_rectangle() + body.has_disc() + body.has_ring() + !mesh.empty();
    if (shapes != 1)
        return problem(path,
                       "the body '" + body.name() + "' needs one shape: rectangle, disc, ring, or "
                           + (shapes == 0 ? "mesh" : "mesh, not several"));
    if (mesh.empty() && !body.has_element_size())
        problem(path, "the body '" + body.name() + "' lacks the key 'element_size'");
    if (mesh.empty() && (body.part_size() > 0 || body.material_size() > 0))
        problem(path, "only a body with a 'mesh' has parts and materials of their own");
    if (!mesh.empty() && !mesh.ends_with(".msh") && !mesh.ends_with(".geo"))
        problem(path + ".mesh", "a mesh is a .msh file, or a .geo file that gmsh meshes");
    if (mesh.ends_with(".msh") && body.has_element_size())
        problem(path + ".element_size",
                "a .msh file has its own elements; leave element_size out, or give a .geo file");
    for (int i = 0; i < body.material_size(); ++i)
        for (int j = 0; j < i; ++j)
            if (body.material(i).part() == body.material(j).part())
                problem(entry(path + ".material", i) + ".part",
                        "the part '" + body.material(i).part() + "' has a material already");
    if (body.has_ring() && body.ring().inner_radius() >= body.ring().outer_radius())
        problem(path + ".ring", path + ".ring needs an inner radius smaller than its outer one");
    if (body.has_rectangle())
        check_rectangle(body, path);
    if (mesh_.contains(&body))
        check_mesh(body, mesh_.at(&body), path);
    if (region_good_)
        check_clear_of_seams(body, path);
}

void Checker::check_mesh(const v1::Body& body, const solid::Mesh& mesh, const std::string& path) {
    for (const solid::Edge& edge : solid::boundary_edges(mesh)) {
        const Point p = point(mesh.node[edge.a].x(), mesh.node[edge.a].y());
        if (region_good_ && !inside(region_, p, tolerance_)) {
            problem(path + ".mesh",
                    "the body '" + body.name() + "' reaches out of fluid.region at " + at_text(p)
                        + "; it may touch the region's boundary from within");
            break;
        }
    }
    std::vector<std::string> names = mesh.part_name;
    std::erase(names, "");
    for (int i = 0; i < body.material_size(); ++i) {
        const std::string& part = body.material(i).part();
        if (std::find(names.begin(), names.end(), part) == names.end())
            problem(entry(path + ".material", i) + ".part",
                    "the mesh has no part '" + part + "'; "
                        + (names.empty() ? "its surfaces carry no names"
                                         : "there is " + list(names, "and")));
    }
}

void Checker::check_rectangle(const v1::Body& body, const std::string& path) {
    const v1::Rectangle& rectangle = body.rectangle();
    if (region_good_ && !rectangle_inside(rectangle, region_, tolerance_))
        problem(path + ".rectangle",
                "the body '" + body.name()
                    + "' reaches out of fluid.region; it may touch the "
                      "region's boundary from within");
    if (body.element_size() > std::min(rectangle.width(), rectangle.height()) * (1 + 1e-9))
        problem(path + ".element_size",
                path + ".element_size is larger than the body's shorter side, "
                    + number_text(std::min(rectangle.width(), rectangle.height())) + " m");
}

/// The curves of a body's shape; those of a .geo file are known to the solid alone.
std::vector<std::string> Checker::curves_of(const v1::Body& body) const {
    if (mesh_.contains(&body))
        return boundary_curves(mesh_.at(&body));
    if (body.has_rectangle())
        return {"left", "right", "bottom", "top"};
    if (body.has_disc())
        return {"rim"};
    if (body.has_ring())
        return {"inner", "outer"};
    return {};
}

void Checker::check_boundary(const v1::Boundary& boundary,
                             const v1::Body& body,
                             const std::string& path) {
    if ((boundary.along_size() > 0) != boundary.curve().empty())
        return problem(path, path + " needs either 'along' or 'curve' to say where it is");
    check_conditions(boundary, body, path);
    for (const v1::Boundary& other : body.boundary()) {
        if (&other == &boundary)
            break;
        if (boundary.curve().empty() || other.curve() != boundary.curve())
            continue;
        if ((boundary.has_temperature() && other.has_temperature())
            || (tells_motion(boundary, true) && tells_motion(other, true))
            || (tells_motion(boundary, false) && tells_motion(other, false)))
            problem(path,
                    "the boundaries '" + other.name() + "' and '" + boundary.name()
                        + "' prescribe the same on the curve '" + boundary.curve()
                        + "'; keep one of them");
    }
    if (boundary.has_temperature() && (!is_zero(boundary.heat_flux()) || boundary.has_convection()))
        problem(path + ".temperature",
                path + " prescribes a temperature and a heat flux or convection; keep one of them");
    if (!boundary.curve().empty()) {
        const std::vector<std::string> known = curves_of(body);
        if ((!known.empty() || mesh_.contains(&body))
            && std::find(known.begin(), known.end(), boundary.curve()) == known.end())
            problem(path + ".curve",
                    "the body has no curve '" + boundary.curve() + "' on its boundary; "
                        + (known.empty() ? "its curves carry no names"
                                         : "there is " + list(known, "and")));
        return;
    }
    const Point& a = boundary.along(0);
    const Point& b = boundary.along(boundary.along_size() - 1);
    if (distance(a, b) <= tolerance_)
        return problem(path + ".along", path + ".along needs two different points");
    if (mesh_.contains(&body)) {
        const auto on_it = [&](const solid::Point& p) {
            return on_piece(point(p.x(), p.y()), a, b, tolerance_);
        };
        const solid::Mesh& mesh = mesh_.at(&body);
        const std::vector<solid::Edge> edges = solid::boundary_edges(mesh);
        if (std::none_of(edges.begin(), edges.end(), [&](const solid::Edge& edge) {
                return on_it(mesh.node[edge.a]) && on_it(mesh.node[edge.b]);
            }))
            problem(path + ".along",
                    "no side of the body lies between " + at_text(a) + " and " + at_text(b));
        return;
    }
    if (!body.has_rectangle())
        return; // the solid knows where its boundary runs
    const Polygon sides = corners(body.rectangle());
    double found = 0;
    for (std::size_t i = 0; i < sides.size(); ++i)
        found += common_length(a, b, sides[i], sides[(i + 1) % sides.size()], tolerance_);
    if (found <= tolerance_)
        problem(path + ".along",
                "no side of the body lies between " + at_text(a) + " and " + at_text(b));
}

/// What is prescribed on a boundary goes together, and with the body.
void Checker::check_conditions(const v1::Boundary& boundary,
                               const v1::Body& body,
                               const std::string& path) {
    const auto once = [&](const char* along, bool fixed, bool displacement, bool velocity) {
        if (fixed + displacement + velocity > 1)
            problem(path,
                    path + " tells the motion along " + along
                        + " twice; keep one of fixed, displacement and velocity");
    };
    once("x", boundary.fixed_x(), boundary.has_displacement_x(), boundary.has_velocity_x());
    once("y", boundary.fixed_y(), boundary.has_displacement_y(), boundary.has_velocity_y());
    const bool moved = boundary.has_displacement_x() || boundary.has_displacement_y()
                       || boundary.has_velocity_x() || boundary.has_velocity_y();
    const bool loaded = !is_zero(boundary.traction()) || !is_zero(boundary.pressure());
    const bool rigid = body.motion() == v1::Body::RIGID;
    if (rigid && (moved || boundary.fixed_x() || boundary.fixed_y()))
        problem(path,
                "a body with motion = \"rigid\" is not held at its boundary; its 'support' says "
                "what holds it");
    else if ((moved || (loaded && !rigid)) && body.motion() != v1::Body::DEFORMABLE)
        problem(path,
                "only a body with motion = \"deformable\" is loaded or moved at its boundary");
}

} // namespace duet::orchestrator
