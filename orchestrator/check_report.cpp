#include "orchestrator/check_report.hpp"

#include "orchestrator/calendar.hpp"
#include "orchestrator/geometry.hpp"
#include "orchestrator/progress.hpp"
#include "orchestrator/schema.hpp"
#include "protocol/function.hpp"
#include "protocol/implicit_worth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace duet::orchestrator {

namespace {

// Rough constants of the estimate, from runs on one core of an ordinary machine.
constexpr double particle_steps_per_second = 2e6; // full particle steps a CPU second
constexpr double node_steps_per_second = 1e8;     // heat steps of a solid's node a CPU second
constexpr double bytes_per_particle = 1500;
constexpr double bytes_per_node = 500;
constexpr double bytes_of_a_process = 30e6;
constexpr double diffusive_share = 0.18; // outer step: 0.18 spacing^2 / max(nu, alpha)
constexpr double flow_share = 0.4;       // outer step: 0.4 spacing / speed
// The paper's formulation: 0.15 spacing^2 / max(nu, alpha), 0.3 spacing / (sound + speed), and the
// sound is ten times as fast as the flow.
constexpr double paper_diffusive_share = 0.15, paper_flow_share = 0.3 / 11;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

std::string count(double value) {
    char text[32];
    std::snprintf(text, sizeof text, value < 1e9 ? "%.0f" : "%.1e", value);
    return text;
}

double diffusivity(double conductivity, double density, double heat_capacity) {
    return conductivity / (density * heat_capacity);
}

/// Places at which the formulas of a scene are tried.
std::vector<Point> places_of(const v1::Scene& scene) {
    std::vector<Point> places = outline(scene.fluid());
    for (const v1::Body& body : scene.solid().body()) {
        const std::vector<Point> more = outline(body);
        places.insert(places.end(), more.begin(), more.end());
    }
    if (places.empty())
        places.push_back(point(0, 0));
    return places;
}

/// Some of the values that the functions of a scene take: those of a table, and those of a formula
/// at corners and at three times.
class Values {
  public:
    explicit Values(const v1::Scene& scene) : places_(places_of(scene)), end_(scene.time().end()) {}

    std::vector<double> of(const v1::Function& function) const {
        if (function.has_table())
            return {function.table().value().begin(), function.table().value().end()};
        if (!function.has_formula())
            return {function.number()};
        const protocol::Function formula(function);
        std::vector<double> values;
        for (const Point& place : places_)
            for (const double time : {0.0, end_ / 3, end_}) {
                try {
                    values.push_back(formula(place.x(), place.y(), time));
                } catch (const std::runtime_error&) { // not finite there; the solver tells
                }
            }
        return values;
    }
    double largest(const v1::Function& function) const {
        double size = 0;
        for (const double value : of(function))
            size = std::max(size, std::abs(value));
        return size;
    }
    double largest(const v1::VectorFunction& vector) const {
        return std::hypot(largest(vector.x()), largest(vector.y()));
    }

  private:
    std::vector<Point> places_;
    double end_;
};

/// In a cavity of this extent.
double wall_speed(const v1::Wall& wall, double extent, const Values& values) {
    const double rate = wall.has_rotation() ? values.largest(wall.rotation().rate()) : 0;
    return values.largest(wall.velocity()) + rate * extent / 2;
}

std::string heat_condition(const v1::Wall& wall) {
    const auto text = [](const v1::Function& f, const std::string& unit) {
        return f.has_number()  ? number_text(f.number()) + unit
               : f.has_table() ? "a table in time," + unit
                               : f.formula() + unit;
    };
    if (wall.has_temperature())
        return text(wall.temperature(), " K");
    return protocol::is_zero(wall.heat_flux()) ? "adiabatic" : text(wall.heat_flux(), " W/m2");
}

/// Every temperature of the scene; all equal means that no heat flows.
std::vector<double> temperatures(const v1::Scene& scene) {
    const Values values(scene);
    std::vector<double> all;
    const auto add = [&](const v1::Function& function) {
        const std::vector<double> more = values.of(function);
        all.insert(all.end(), more.begin(), more.end());
    };
    if (scene.has_fluid())
        add(scene.fluid().initial_temperature());
    for (const v1::Wall& wall : scene.fluid().wall())
        if (wall.has_temperature())
            add(wall.temperature());
    for (const v1::Body& body : scene.solid().body()) {
        add(body.initial_temperature());
        for (const v1::Boundary& boundary : body.boundary()) {
            if (boundary.has_temperature())
                add(boundary.temperature());
            if (boundary.has_convection())
                add(boundary.convection().temperature());
        }
    }
    return all;
}

bool heat_released(const v1::Scene& scene) {
    for (const v1::Wall& wall : scene.fluid().wall())
        if (!protocol::is_zero(wall.heat_flux()))
            return true;
    for (const v1::Body& body : scene.solid().body()) {
        if (body.heat_source() != 0)
            return true;
        for (const v1::Boundary& boundary : body.boundary())
            if (!protocol::is_zero(boundary.heat_flux()))
                return true;
    }
    return false;
}

struct Estimate {
    double temperature_range = 0; // K
    bool heat = false;
    bool buoyancy = false;
    double speed = 0;      // m/s, of free convection or as given
    double fluid_step = 0; // s
    double window = 0;     // s
};

Estimate estimate(const v1::Scene& scene) {
    Estimate out;
    const std::vector<double> all = temperatures(scene);
    const auto [low, high] = std::minmax_element(all.begin(), all.end());
    out.temperature_range = all.empty() ? 0 : *high - *low;
    out.heat = out.temperature_range > 0 || heat_released(scene);
    if (!scene.has_fluid())
        return out;
    const v1::Fluid& fluid = scene.fluid();
    const double gravity = distance(point(0, 0), scene.gravity());
    out.buoyancy = out.heat && gravity > 0 && fluid.thermal_expansion() > 0;
    const Polygon region = outline(fluid);
    // Free convection over the height of the cavity at a third of the free fall's speed.
    if (out.buoyancy)
        out.speed =
            std::sqrt(gravity * fluid.thermal_expansion() * out.temperature_range * extent(region))
            / 3;
    const Values values(scene);
    out.speed = std::max(out.speed, values.largest(fluid.initial_velocity()));
    for (const v1::Wall& wall : fluid.wall())
        out.speed = std::max(out.speed, wall_speed(wall, extent(region), values));
    const double slowest = std::max(
        fluid.kinematic_viscosity(),
        out.heat ? diffusivity(fluid.conductivity(), fluid.density(), fluid.heat_capacity()) : 0);
    const double dx = fluid.spacing(), none = std::numeric_limits<double>::infinity();
    const bool paper = fluid.formulation() == v1::Fluid::PAPER; // which steps with the sound
    out.fluid_step = std::min(
        {scene.time().end(),
         slowest > 0 ? (paper ? paper_diffusive_share : diffusive_share) * dx * dx / slowest : none,
         out.speed > 0 ? (paper ? paper_flow_share : flow_share) * dx / out.speed : none});
    out.window = scene.time().window() > 0 ? scene.time().window() : out.fluid_step;
    return out;
}

void describe_fluid(const v1::Scene& scene, const Estimate& e, std::string& out) {
    const v1::Fluid& fluid = scene.fluid();
    out += "fluid   " + count(particles_of(scene)) + " particles, spacing "
           + number_text(fluid.spacing()) + " m; weakly compressible flow with viscosity\n";
    out += "        heat: "
           + std::string(e.heat ? "conduction and convection"
                                : "left out (one temperature everywhere)")
           + "; buoyancy: "
           + (e.buoyancy ? "yes"
              : !e.heat  ? "left out (no heat)"
                         : "left out (no gravity or no expansion)")
           + "\n";
    const auto [along_x, along_y] = periodic(fluid);
    if (along_x || along_y)
        out += "        periodic along "
               + std::string(along_x && along_y ? "x and y"
                             : along_x          ? "x"
                                                : "y")
               + ": the region is one period\n";
    for (const v1::Wall& wall : fluid.wall())
        out +=
            "        wall '" + wall.name() + "': " + heat_condition(wall)
            + (wall.slip() ? ", slips" : "")
            + (wall_speed(wall, extent(outline(fluid)), Values(scene)) > 0 ? ", moving\n" : "\n");
    for (const v1::Hole& hole : fluid.hole())
        out +=
            "        hole '" + hole.name() + "' of " + number_text(area(outline(hole))) + " m2\n";
    if (!(along_x && along_y) || fluid.hole_size() > 0)
        out += "        all other walls: fixed, no-slip, adiabatic\n";
}

/// Roughly the longest explicit step of a body, s; infinite without a limit, and where a mesh file
/// tells its sizes to the solid alone.
double explicit_step(const v1::Body& body, const Estimate& e) {
    double step = std::numeric_limits<double>::infinity();
    const double h = body.element_size();
    if (h == 0)
        return step;
    const double alpha = diffusivity(body.conductivity(), body.density(), body.heat_capacity());
    if (e.heat && alpha > 0)
        step = 0.25 * h * h / alpha;
    if (body.motion() == v1::Body::DEFORMABLE) {
        const double nu = body.poissons_ratio();
        const double stiffness = body.youngs_modulus() * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
        step = std::min(step, 0.5 * h / std::sqrt(stiffness / body.density()));
    }
    return step;
}

/// The solid decides with its own stable step; this is what it is likely to say.
std::string automatic_steps(const v1::Body& body, const Estimate& e) {
    const double steps = e.window / explicit_step(body, e);
    const double worth = protocol::implicit_worth(body);
    if (!(steps > 0))
        return "explicit or implicit, as the first window shows";
    return std::string(steps > worth ? "implicit" : "explicit") + " (about "
           + number(std::ceil(steps))
           + " explicit ones in a window; an implicit one costs as much as " + number(worth) + ")";
}

void describe_solid(const v1::Scene& scene, const Estimate& e, std::string& out) {
    for (const v1::Body& body : scene.solid().body()) {
        out += "solid   body '" + body.name()
               + "': " + (nodes_of(body) > 0 ? count(nodes_of(body)) + " nodes, " : "")
               + (body.mesh().empty() ? "edge " + number_text(body.element_size()) + " m"
                                      : "mesh " + body.mesh())
               + "; mechanics: "
               + (body.motion() == v1::Body::DEFORMABLE   ? "thermo-elastic, finite deformation"
                  : body.motion() == v1::Body::PRESCRIBED ? "left out (rigid, moved as prescribed)"
                  : body.motion() == v1::Body::RIGID      ? "rigid, moved by the forces on it"
                                                          : "left out (fixed and rigid)")
               + "; heat: "
               + (protocol::heats_itself(body) ? "conduction and thermo-elastic heating"
                  : e.heat                     ? "conduction"
                                               : "left out (one temperature everywhere)")
               + "; steps: "
               + (body.stepping() == v1::Body::IMPLICIT    ? "implicit"
                  : body.stepping() == v1::Body::AUTOMATIC ? automatic_steps(body, e)
                                                           : "explicit")
               + "\n";
    }
}

/// The two limits of the staggered exchange (frozen loads in a window).
void describe_coupling(const v1::Scene& scene, const Estimate& e, std::string& out) {
    const v1::Fluid& fluid = scene.fluid();
    out += "coupling "
           + choices(*v1::Coupling::descriptor()->FindFieldByName(
               "schedule"))[static_cast<std::size_t>(scene.coupling().schedule())]
           + ", windows of about " + number(e.window) + " s\n";
    for (const v1::Body& body : scene.solid().body()) {
        if (body.element_size() == 0)
            continue; // the solid reports its limits when it has read the mesh
        if (e.heat && fluid.conductivity() > 0 && !body.insulated()) {
            // The first layer of the solid must not overshoot:
            // rho_s c_s dx_s / 2 > 2 window k_f / (0.5 dx).
            const double longest = body.density() * body.heat_capacity() * body.element_size() / 4
                                   * 0.5 * fluid.spacing() / fluid.conductivity();
            out += "        '" + body.name() + "', heat: windows up to " + number(longest)
                   + " s are stable; " + number(longest / e.window) + " times the window"
                   + (longest < e.window ? ": TOO CLOSE, shorten time.window" : "") + "\n";
        }
        if (body.motion() == v1::Body::DEFORMABLE) {
            if (const double viscosity = fluid.density() * fluid.kinematic_viscosity();
                viscosity > 0) {
                // rho_s dx_s / 2 > 2 window mu / (0.5 dx)
                const double longest =
                    0.25 * body.density() * body.element_size() * 0.5 * fluid.spacing() / viscosity;
                out += "        '" + body.name() + "', drag: windows up to " + number(longest)
                       + " s are stable" + (longest < e.window ? ", the run takes those" : "")
                       + "\n";
            }
            // In a window the fluid reacts with the mass rho_f c window on each area:
            // rho_s dx_s must exceed it.
            const double sound = fluid.sound_speed() > 0 ? fluid.sound_speed() : 10 * e.speed;
            if (sound == 0) {
                out += "        '" + body.name()
                       + "', added mass: not known before the run, for nothing here sets a speed; "
                         "the windows will follow the sound\n";
                continue;
            }
            const double mass = fluid.density() * sound * e.window;
            const double ratio = body.density() * body.element_size() / mass;
            out += "        '" + body.name() + "', added mass: the first layer weighs "
                   + number(ratio) + " times what the fluid moves in a window"
                   + (ratio < 1 ? ": TOO LIGHT, shorten time.window" : "") + "\n";
        }
    }
}

void describe_cost(const v1::Scene& scene,
                   const Estimate& e,
                   std::uint32_t threads,
                   std::string& out) {
    double seconds = 0;
    double bytes = 0;
    out += "cost    rough, from constants of one core: ";
    if (scene.has_fluid()) {
        const double steps = scene.time().end() / std::min(e.fluid_step, e.window);
        seconds += steps * particles_of(scene) / particle_steps_per_second;
        bytes += bytes_of_a_process + particles_of(scene) * bytes_per_particle;
        out += count(steps) + " steps of the fluid, ";
    }
    if (scene.has_solid()) {
        double nodes = 0;
        double step = scene.time().end();
        for (const v1::Body& body : scene.solid().body()) {
            nodes += nodes_of(body);
            if (body.stepping() != v1::Body::IMPLICIT)
                step = std::min(step, explicit_step(body, e));
        }
        if (e.window > 0)
            step = std::min(step, e.window);
        const double steps = scene.time().end() / step;
        seconds += steps * nodes / node_steps_per_second;
        bytes += bytes_of_a_process + nodes * bytes_per_node;
        out += count(steps) + " of the solid, ";
    }
    out += duration_text(seconds) + " of CPU time, " + count(bytes / 1e6) + " MB\n";
    out +=
        "cores   " + std::to_string(threads) + " threads for each solver"
        + (scene.has_fluid() && scene.has_solid()
               ? scene.coupling().schedule() == v1::Coupling::PARALLEL ? " (both advance at once)"
                                                                       : " (the two take turns)"
               : "")
        + "\n";
}

} // namespace

std::string check_report(const Case& given, std::uint32_t threads) {
    const v1::Scene& scene = given.scene;
    const Estimate e = estimate(scene);
    std::string out = given.name + ": " + scene.title() + "\n\n";
    out += "time    0 to " + number_text(scene.time().end()) + " s, "
           + std::to_string(marks_of(scene).size()) + " times at which something is recorded\n";
    if (scene.has_fluid())
        describe_fluid(scene, e, out);
    else
        out += "fluid   none: no fluid process is started\n";
    if (scene.has_solid())
        describe_solid(scene, e, out);
    else
        out += "solid   none: no solid process is started\n";
    if (scene.has_fluid() && scene.has_solid())
        describe_coupling(scene, e, out);
    describe_cost(scene, e, threads, out);
    out += "records " + std::to_string(scene.probe_size()) + " probes, held against references by "
           + std::to_string(scene.check_size()) + " checks\n";
    return out;
}

} // namespace duet::orchestrator
