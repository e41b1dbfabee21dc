#include "fluid_solver/fluid_probes.hpp"

#include "protocol/probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace duet::fluid {

namespace {

struct Field {
    const char* name;
    bool odd; ///< changes sign in a vertical mirror
    double (*value)(const Values&, const v1::Probe&, const v1::Scene&);
};

struct Integral {
    const char* name;
    double (*value)(const Ledger&);
};

struct WallQuantity {
    const char* name;
    double (*value)(const WallReport&, const v1::Scene&);
};

constexpr Integral integrals[] = {
    {"mean_temperature", [](const Ledger& l) { return l.mean_temperature; }},
    {"heat", [](const Ledger& l) { return l.heat; }},
    {"heat_received", [](const Ledger& l) { return l.heat_from_interface; }},
    {"force_on_solids_x", [](const Ledger& l) { return l.force_on_solids.x; }},
    {"force_on_solids_y", [](const Ledger& l) { return l.force_on_solids.y; }},
    {"heat_flow_to_solids", [](const Ledger& l) { return l.heat_flow_to_solids; }},
    {"heat_from_walls", [](const Ledger& l) { return l.heat_from_walls; }},
    {"kinetic_energy", [](const Ledger& l) { return l.kinetic_energy; }},
    {"max_speed", [](const Ledger& l) { return l.max_speed; }},
    {"sound_speed", [](const Ledger& l) { return l.sound_speed; }},
    {"mass", [](const Ledger& l) { return l.mass; }},
};

/// Largest difference between the temperatures prescribed on the walls, if they are numbers.
double wall_temperature_difference(const v1::Scene& scene) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const auto& wall : scene.fluid().wall()) {
        if (wall.temperature().has_number()) {
            low = std::min(low, wall.temperature().number());
            high = std::max(high, wall.temperature().number());
        }
    }
    return high - low;
}

/// (66): mean heat flux through the wall over conduction across a cavity as wide as the wall is
/// long.
double nusselt(const WallReport& wall, const v1::Scene& scene) {
    return std::abs(wall.heat_flow)
           / (scene.fluid().conductivity() * wall_temperature_difference(scene));
}

/// rho c v (T - T_ref) - k grad T, W/m2. (The reference matters only where mass crosses a line.)
Vec2 heat_flux(const Values& f, const v1::Fluid& fluid) {
    const double carried =
        fluid.density() * fluid.heat_capacity() * (f.temperature - fluid.reference_temperature());
    return carried * f.velocity - fluid.conductivity() * f.temperature_slope;
}

/// (66) at a point of a line: heat flux to the line's right over conduction across a cavity as wide
/// as the line is long. Its mean over the line is the line's Nusselt number.
double nusselt_across(const Values& f, const v1::Probe& probe, const v1::Scene& scene) {
    const Vec2 along{probe.line(1).x() - probe.line(0).x(), probe.line(1).y() - probe.line(0).y()};
    return dot(heat_flux(f, scene.fluid()), -left(along))
           / (scene.fluid().conductivity() * wall_temperature_difference(scene));
}

using Probe = v1::Probe;
using Scene = v1::Scene;

constexpr Field fields[] = {
    {"temperature",
     false,
     [](const Values& f, const Probe&, const Scene&) { return f.temperature; }},
    {"velocity_x", true, [](const Values& f, const Probe&, const Scene&) { return f.velocity.x; }},
    {"velocity_y", false, [](const Values& f, const Probe&, const Scene&) { return f.velocity.y; }},
    {"speed", false, [](const Values& f, const Probe&, const Scene&) { return norm(f.velocity); }},
    {"pressure", false, [](const Values& f, const Probe&, const Scene&) { return f.pressure; }},
    {"heat_flux_x",
     true,
     [](const Values& f, const Probe&, const Scene& s) { return heat_flux(f, s.fluid()).x; }},
    {"heat_flux_y",
     false,
     [](const Values& f, const Probe&, const Scene& s) { return heat_flux(f, s.fluid()).y; }},
    {"nusselt", false, nusselt_across},
};

constexpr WallQuantity wall_quantities[] = {
    {"heat_flow", [](const WallReport& w, const v1::Scene&) { return w.heat_flow; }},
    {"heat", [](const WallReport& w, const v1::Scene&) { return w.heat; }},
    {"nusselt", nusselt},
    {"force_x", [](const WallReport& w, const v1::Scene&) { return w.force.x; }},
    {"force_y", [](const WallReport& w, const v1::Scene&) { return w.force.y; }},
    {"torque", [](const WallReport& w, const v1::Scene&) { return w.torque; }},
};

template <typename Table>
auto find(const Table& table, const std::string& name) {
    return std::find_if(
        std::begin(table), std::end(table), [&](const auto& row) { return name == row.name; });
}

template <typename Table>
void require_known(const Table& table, const v1::Probe& probe, const std::string& kind) {
    if (find(table, probe.quantity()) != std::end(table)) {
        return;
    }
    std::string known;
    for (const auto& row : table) {
        known += (known.empty() ? "" : ", ") + std::string(row.name);
    }
    throw SceneError("Probe \"" + probe.name() + "\": the fluid has no quantity \""
                     + probe.quantity() + "\" " + kind + "; it knows " + known + ".");
}

const WallReport& wall_named(const v1::Probe& probe, const Fluid& fluid) {
    for (const auto& wall : fluid.walls()) {
        if (wall.name == probe.wall()) {
            return wall;
        }
    }
    throw SceneError("Probe \"" + probe.name() + "\" names the wall \"" + probe.wall()
                     + "\", which the fluid does not have; name a [[fluid.wall]].");
}

void check_nusselt(const v1::Probe& probe, const v1::Scene& scene) {
    if (probe.quantity() != "nusselt") {
        return;
    }
    if (!(wall_temperature_difference(scene) > 0 && scene.fluid().conductivity() > 0)) {
        throw SceneError("Probe \"" + probe.name()
                         + "\": a Nusselt number needs two walls of different temperature and "
                           "a fluid that conducts.");
    }
    if (probe.wall().empty() && (probe.line_size() != 2 || probe.has_mirror())) {
        throw SceneError("Probe \"" + probe.name()
                         + "\": a Nusselt number is that of a wall or across a line, without a "
                           "mirror.");
    }
}

} // namespace

void check_probe(const v1::Probe& probe, const v1::Scene& scene, const Fluid& fluid) {
    if (protocol::is_field_probe(probe)) {
        require_known(fields, probe, "at points");
        check_nusselt(probe, scene);
        if (take_probe(probe, scene, fluid).value().empty()) {
            throw SceneError("Probe \"" + probe.name()
                             + "\" lies outside the fluid; move it into the fluid's region, clear "
                               "of the solids.");
        }
    } else if (!probe.wall().empty()) {
        require_known(wall_quantities, probe, "on a wall");
        wall_named(probe, fluid);
        check_nusselt(probe, scene);
    } else {
        require_known(integrals, probe, "over the domain");
    }
}

v1::Sample take_probe(const v1::Probe& probe, const v1::Scene& scene, const Fluid& fluid) {
    if (protocol::is_field_probe(probe)) {
        const auto& field = *find(fields, probe.quantity());
        std::vector<double> values;
        for (const auto& point : protocol::probe_points(probe)) {
            values.push_back(field.value(fluid.at({point.x(), point.y()}), probe, scene));
        }
        return protocol::field_sample(probe, fluid.time(), values, field.odd);
    }
    if (!probe.wall().empty()) {
        return protocol::integral_sample(
            probe,
            fluid.time(),
            find(wall_quantities, probe.quantity())->value(wall_named(probe, fluid), scene));
    }
    return protocol::integral_sample(
        probe, fluid.time(), find(integrals, probe.quantity())->value(fluid.ledger()));
}

} // namespace duet::fluid
