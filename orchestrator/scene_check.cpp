#include "orchestrator/scene_check.hpp"

#include "orchestrator/figures.hpp"
#include "orchestrator/geometry.hpp"
#include "orchestrator/mesh_body.hpp"
#include "orchestrator/reference_table.hpp"
#include "orchestrator/schema.hpp"
#include "protocol/function.hpp"
#include "solid_solver/locator.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace duet::orchestrator {

namespace {

std::string entry(const std::string& path, int i) {
    return path + "[" + std::to_string(i) + "]";
}

std::string at_text(const Point& p) {
    return "[" + number_text(p.x()) + ", " + number_text(p.y()) + "]";
}

/// The end of the run, but for rounding.
double latest(const v1::Scene& scene) {
    return scene.time().end() * (1 + 1e-12);
}

/// True if the end of the run was given on the command line.
bool shortened(const Case& given) {
    return given.overridden.contains("time.end");
}

using protocol::is_zero;

class Checker {
  public:
    explicit Checker(const Case& given) : case_(given), scene_(given.scene) {
        region_ = outline(scene_.fluid());
        double size = region_.empty() ? 0 : extent(region_);
        for (const v1::Body& body : scene_.solid().body())
            size = std::max({size,
                             body.rectangle().width(),
                             body.rectangle().height(),
                             body.disc().radius(),
                             body.ring().outer_radius()});
        for (int i = 0; i < scene_.solid().body_size(); ++i) {
            const v1::Body& body = scene_.solid().body(i);
            std::string fault;
            if (auto mesh = mesh_of(body, &fault)) {
                for (const solid::Point& p : mesh->node)
                    size = std::max(size, (p - mesh->node.front()).cwiseAbs().maxCoeff());
                mesh_.emplace(&body, std::move(*mesh));
            } else if (!fault.empty()) {
                problem(entry("solid.body", i) + ".mesh", fault);
            }
        }
        tolerance_ = 1e-9 * size;
    }

    std::vector<Problem> run() {
        if (!scene_.has_fluid() && !scene_.has_solid())
            problem("", "the case holds neither [fluid] nor [solid]: there is nothing to model");
        if (scene_.time().window() > scene_.time().end())
            problem("time.window", "time.window must not be longer than time.end");
        check_interval("output.interval", scene_.output().interval());
        check_interval("output.probe_interval", scene_.output().probe_interval());
        if (scene_.has_fluid())
            check_fluid();
        if (scene_.has_solid())
            check_bodies();
        check_names("probe", scene_.probe());
        for (int i = 0; i < scene_.probe_size(); ++i)
            check_probe(scene_.probe(i), entry("probe", i));
        for (int i = 0; i < scene_.check_size(); ++i)
            check_check(scene_.check(i), entry("check", i));
        return problems_;
    }

  private:
    void check_fluid();
    void check_hole(const v1::Hole& hole, const std::string& path);
    void check_wall(const v1::Wall& wall, const std::string& path);
    Polygon outline_of(const std::string& around) const;
    void check_slip(const v1::Wall& wall, const std::string& path);
    void check_sharing(const v1::Wall& wall, const std::string& path);
    void check_motion(const v1::Body& body, const std::string& path);
    void check_point_loads(const v1::Body& body, const std::string& path);
    void check_size(double count, const std::string& what, const std::string& path);
    void steady_in_place(const v1::Function& function, const std::string& path);
    void check_bodies();
    void check_body(const v1::Body& body, const std::string& path);
    void check_shape(const v1::Body& body, const std::string& path);
    void check_rectangle(const v1::Body& body, const std::string& path);
    void check_mesh(const v1::Body& body, const solid::Mesh& mesh, const std::string& path);
    std::vector<std::string> curves_of(const v1::Body& body) const;
    bool holds(const v1::Body& body, const Point& p, bool otherwise) const;
    void
    check_boundary(const v1::Boundary& boundary, const v1::Body& body, const std::string& path);
    void
    check_conditions(const v1::Boundary& boundary, const v1::Body& body, const std::string& path);
    void check_probe(const v1::Probe& probe, const std::string& path);
    void check_probed_boundary(const v1::Probe& probe, const std::string& path);
    void check_place(const v1::Probe& probe, const Point& p, const std::string& path);
    void check_check(const v1::Check& check, const std::string& path);
    void check_mean(const v1::Check& check, const v1::Probe* probe, const std::string& path);
    void check_quantity(const v1::Check& check, const v1::Probe* probe, const std::string& path);
    void check_reference(const v1::Check& check, const v1::Probe* probe, const std::string& path);
    const v1::Probe* find_probe(const std::string& name) const;

    /// Names find things again, and head the columns of CSV files.
    template <class Entries>
    void check_names(const std::string& path, const Entries& entries) {
        std::set<std::string> seen;
        for (int i = 0; i < entries.size(); ++i) {
            const std::string& name = entries.Get(i).name();
            const std::string at = entry(path, i) + ".name";
            if (name.empty() || name.find_first_of(",\"\n\r#") != std::string::npos)
                problem(at, at + " must be a word, without commas, quotes, or '#'");
            else if (!seen.insert(name).second)
                problem(at,
                        "the name '" + name + "' is already taken; each [[" + path
                            + "]] needs its own");
        }
    }

    template <class Entries>
    void must_be_known(const std::string& name,
                       const std::string& what,
                       const Entries& entries,
                       const std::string& path) {
        std::vector<std::string> names;
        for (const auto& one : entries)
            names.push_back(one.name());
        if (std::find(names.begin(), names.end(), name) != names.end())
            return;
        const auto near = nearest(name, names);
        problem(path,
                "there is no " + what + " '" + name + "'"
                    + (near            ? "; did you mean '" + *near + "'?"
                       : names.empty() ? "; the case has none"
                                       : "; there is " + list(names, "and")));
    }

    /// So many records would fill memory and disk before the run has an end.
    void check_interval(const std::string& path, double interval) {
        constexpr double most = 1e6;
        if (interval > 0 && scene_.time().end() / interval > most)
            problem(path,
                    path + " asks for more than a million records until time.end; make it longer");
    }

    void problem(const std::string& path, const std::string& sentence) {
        problems_.push_back({case_.places.find(path), sentence});
    }

    const Case& case_;
    const v1::Scene& scene_;
    std::map<const v1::Body*, solid::Mesh> mesh_; // of .msh files that can be computed with
    Polygon region_;
    double tolerance_ = 0;
    bool region_good_ = false;
    std::vector<Problem> problems_;
};

void Checker::check_fluid() {
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
    check_size(particles_of(scene_), "fluid particles", "fluid.spacing");
    check_names("fluid.hole", scene_.fluid().hole());
    for (int i = 0; i < scene_.fluid().hole_size(); ++i)
        check_hole(scene_.fluid().hole(i), entry("fluid.hole", i));
    check_names("fluid.wall", scene_.fluid().wall());
    for (int i = 0; i < scene_.fluid().wall_size(); ++i)
        check_wall(scene_.fluid().wall(i), entry("fluid.wall", i));
}

/// What no machine of the kind that runs this holds in its memory.
void Checker::check_size(double count, const std::string& what, const std::string& path) {
    constexpr double most = 1e8;
    if (count > most)
        problem(path,
                path + " makes " + number_text(std::round(count)) + " " + what
                    + "; make it larger");
}

/// A rigid motion is that of a whole.
void Checker::steady_in_place(const v1::Function& function, const std::string& path) {
    if (protocol::Function(function).depends_on_place())
        problem(path, path + " moves a whole: it may depend on the time t, not on x or y");
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
    if (wall.has_temperature()
        && (!wall.heat_flux().has_number() || wall.heat_flux().number() != 0))
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
        const auto moved = [](const v1::Boundary& b, bool x) {
            return x ? b.fixed_x() || b.has_displacement_x() || b.has_velocity_x()
                     : b.fixed_y() || b.has_displacement_y() || b.has_velocity_y();
        };
        if ((boundary.has_temperature() && other.has_temperature())
            || (moved(boundary, true) && moved(other, true))
            || (moved(boundary, false) && moved(other, false)))
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

void Checker::check_probe(const v1::Probe& probe, const std::string& path) {
    const bool of_fluid = probe.of() == v1::Probe::FLUID;
    if (of_fluid ? !scene_.has_fluid() : !scene_.has_solid())
        return problem(path + ".of",
                       std::string("the case has no [") + (of_fluid ? "fluid" : "solid")
                           + "] that could measure it");
    if (probe.line_size() == 0 && probe.reduce() != v1::Probe::EACH)
        problem(path + ".reduce", "only the values along a line are reduced");
    if (probe.has_at() && probe.line_size() > 0)
        problem(path, "a probe is taken at a point or along a line, not both");
    if (probe.line_size() == 1
        || (probe.line_size() == 2 && distance(probe.line(0), probe.line(1)) <= tolerance_))
        return problem(path + ".line", path + ".line needs two different end points");
    if (!probe.wall().empty()) {
        if (!of_fluid)
            problem(path + ".wall", "only the fluid has walls; a probe of the solid takes a body");
        must_be_known(probe.wall(), "wall", scene_.fluid().wall(), path + ".wall");
    }
    if (!probe.body().empty()) {
        if (of_fluid)
            problem(path + ".body", "only the solid has bodies; a probe of the fluid takes a wall");
        must_be_known(probe.body(), "body", scene_.solid().body(), path + ".body");
    }
    if (!probe.boundary().empty())
        check_probed_boundary(probe, path);
    if (probe.has_at())
        check_place(probe, probe.at(), path + ".at");
    for (int i = 0; i < probe.line_size(); ++i)
        check_place(probe, probe.line(i), path + ".line");
}

void Checker::check_probed_boundary(const v1::Probe& probe, const std::string& path) {
    if (probe.of() == v1::Probe::FLUID)
        return problem(path + ".boundary",
                       "only bodies have boundaries; a probe of the fluid takes a wall");
    if (probe.has_at() || probe.line_size() > 0)
        problem(path, "a probe is taken over a boundary, or at a point or along a line");
    google::protobuf::RepeatedPtrField<v1::Boundary> known;
    for (const v1::Body& body : scene_.solid().body())
        if (probe.body().empty() || probe.body() == body.name())
            known.MergeFrom(body.boundary());
    must_be_known(probe.boundary(), "boundary", known, path + ".boundary");
}

/// The point lies in the body or on its boundary; `otherwise`, where the checks do not know.
bool Checker::holds(const v1::Body& body, const Point& p, bool otherwise) const {
    if (body.has_rectangle())
        return inside(corners(body.rectangle()), p, tolerance_);
    if (mesh_.contains(&body))
        return solid::interpolation_at(mesh_.at(&body), {p.x(), p.y()}).has_value();
    return otherwise;
}

/// The point, and its mirror image if one is asked for, lie where there is something to measure.
void Checker::check_place(const v1::Probe& probe, const Point& p, const std::string& path) {
    std::vector<Point> points = {p};
    if (probe.has_mirror())
        points.push_back(point(2 * probe.mirror() - p.x(), p.y()));
    for (const Point& q : points) {
        const std::string where = at_text(q) + (&q == &points[0] ? "" : " (the mirror image)");
        if (probe.of() == v1::Probe::SOLID) {
            const auto& bodies = scene_.solid().body();
            const bool found = std::any_of(bodies.begin(), bodies.end(), [&](const v1::Body& body) {
                return (probe.body().empty() || probe.body() == body.name())
                       && holds(body, q, true);
            });
            if (!found)
                problem(path, "the point " + where + " lies in no body");
            continue;
        }
        if (region_good_ && !inside(region_, q, tolerance_))
            problem(path, "the point " + where + " lies outside fluid.region");
        for (const v1::Hole& hole : scene_.fluid().hole())
            if (inside(outline(hole), q, tolerance_) && !on_boundary(outline(hole), q, tolerance_))
                problem(path, "the point " + where + " lies in the hole '" + hole.name() + "'");
        for (const v1::Body& body : scene_.solid().body())
            if (body.has_rectangle() ? strictly_inside(body.rectangle(), q, tolerance_)
                                     : mesh_.contains(&body) && holds(body, q, false))
                problem(path,
                        "the point " + where + " lies in the body '" + body.name()
                            + "', where there is no fluid");
    }
}

const v1::Probe* Checker::find_probe(const std::string& name) const {
    for (const v1::Probe& probe : scene_.probe())
        if (probe.name() == name)
            return &probe;
    return nullptr;
}

void Checker::check_check(const v1::Check& check, const std::string& path) {
    const v1::Probe* probe = find_probe(check.quantity());
    check_quantity(check, probe, path);
    for (int i = 0; i < check.at_size(); ++i)
        if (check.at(i) < 0 || (!shortened(case_) && check.at(i) > latest(scene_)))
            problem(entry(path + ".at", i),
                    "the time " + number_text(check.at(i)) + " lies outside the run, 0 to "
                        + number_text(scene_.time().end()) + " s");
    check_mean(check, probe, path);
    if (check.has_value() == !check.reference().empty())
        return problem(path, "a check needs either a 'value' or a 'reference' with its 'column'");
    if (check.norm() == v1::Check::RELATIVE && check.value() == 0 && check.has_value())
        problem(path + ".norm", "an error cannot be relative to 0; take the norm \"absolute\"");
    if (!check.reference().empty())
        check_reference(check, probe, path);
}

/// A mean over time is that of a probe, and ends after it begins.
void Checker::check_mean(const v1::Check& check, const v1::Probe* probe, const std::string& path) {
    const bool profile = probe && probe->line_size() > 0 && probe->reduce() == v1::Probe::EACH;
    const bool whole = check.norm() == v1::Check::RMS || check.norm() == v1::Check::MAXIMUM;
    if (check.from() > 0 && (!probe || profile || !whole || check.has_mean_from()))
        problem(path + ".from",
                "'from' leaves out the start of a history that is held as a whole, with the norm "
                "\"rms\" or \"maximum\"; leave it out here");
    if (shortened(case_) && std::max(check.from(), check.mean_from()) > latest(scene_))
        return; // left out
    if (check.from() > latest(scene_))
        problem(path + ".from", path + ".from lies after the end of the run");
    if (!check.has_mean_from())
        return;
    double first = scene_.time().end();
    for (const double t : check.at())
        first = std::min(first, t);
    if (check.mean_from() > first)
        problem(path + ".mean_from",
                path + ".mean_from lies after the time at which the check is held, "
                    + number_text(first) + " s");
    if (!probe || (whole && !profile))
        problem(
            path + ".mean_from",
            "a mean over time is taken of a probe; with the norm \"rms\" or \"maximum\", of one "
            "that is a line");
}

/// It names something that the run measures, and the norm fits what is measured.
void Checker::check_quantity(const v1::Check& check,
                             const v1::Probe* probe,
                             const std::string& path) {
    const std::string& name = check.quantity();
    if (!probe) {
        if (check.at_size() > 0)
            problem(path + ".at", "the audit figure '" + name + "' belongs to the whole run");
        for (const char* role : {"fluid", "solid"})
            if (name.rfind(std::string(role) + ".", 0) == 0) {
                if (role == std::string("fluid") ? !scene_.has_fluid() : !scene_.has_solid())
                    problem(path + ".quantity", "the case has no [" + std::string(role) + "]");
                return;
            }
        std::vector<std::string> known;
        for (const Figure& figure : audit_figures())
            known.push_back(figure.name);
        if (std::find(known.begin(), known.end(), name) != known.end())
            return;
        for (const v1::Probe& one : scene_.probe())
            known.push_back(one.name());
        const auto near = nearest(name, known);
        return problem(
            path + ".quantity",
            "'" + name + "' is neither a probe of the case nor an audit figure"
                + (near ? "; did you mean '" + *near + "'?" : "; there is " + list(known, "and")));
    }
    const bool profile = probe->line_size() > 0 && probe->reduce() == v1::Probe::EACH;
    const bool over_points = check.norm() == v1::Check::RMS || check.norm() == v1::Check::MAXIMUM;
    if (profile && !over_points)
        problem(path + ".norm",
                "the probe '" + name + "' is a line: its norm is \"rms\" or \"maximum\"");
}

void Checker::check_reference(const v1::Check& check,
                              const v1::Probe* probe,
                              const std::string& path) {
    try {
        const ReferenceTable table(check.reference());
        for (const auto& [name, key] :
             {std::pair(check.column(), ".column"), std::pair(check.along(), ".along")}) {
            if (table.has(name) || (name.empty() && key == std::string(".along")))
                continue;
            const auto near = nearest(name, table.names());
            problem(path + key,
                    "the reference has no column '" + name + "'"
                        + (near ? "; did you mean '" + *near + "'?"
                                : "; there is " + list(table.names(), "and")));
            return;
        }
        const std::vector<double>& x = table.column(check.along());
        if (!std::is_sorted(x.begin(), x.end()))
            problem(path + ".reference", "the reference's first coordinate does not ascend");
        else if (!probe || probe->line_size() == 0 || probe->reduce() != v1::Probe::EACH)
            for (const double t : check.at())
                table.interpolate(check.column(), check.along(), t);
    } catch (const std::runtime_error& error) {
        problem(path + ".reference", error.what());
    }
}

} // namespace

void check_scene(const Case& given) {
    std::vector<Problem> problems = Checker(given).run();
    if (!problems.empty())
        throw CaseError(std::move(problems));
}

void leave_out_later_checks(Case& given) {
    if (!shortened(given))
        return;
    auto& checks = *given.scene.mutable_check();
    checks.erase(std::remove_if(
                     checks.begin(),
                     checks.end(),
                     [&](v1::Check& check) {
                         if (std::max(check.from(), check.mean_from()) > latest(given.scene))
                             return true;
                         const int before = check.at_size();
                         auto& at = *check.mutable_at();
                         at.erase(std::remove_if(at.begin(),
                                                 at.end(),
                                                 [&](double t) { return t > latest(given.scene); }),
                                  at.end());
                         return before > 0 && at.empty();
                     }),
                 checks.end());
}

} // namespace duet::orchestrator
