#include "orchestrator/audit.hpp"

#include "orchestrator/schema.hpp"

#include <algorithm>
#include <cmath>

namespace duet::orchestrator {

namespace {

/// |a + b| relative to `scale`; 0 if nothing passed at all.
double imbalance(double a, double b, double scale) {
    const double sum = std::abs(a + b);
    return sum == 0 ? 0 : sum / scale;
}

bool finite(const v1::Ledger& ledger) {
    return std::isfinite(ledger.heat() + ledger.heat_from_interface() + ledger.heat_from_walls()
                         + ledger.heat_from_sources() + ledger.impulse_x() + ledger.impulse_y()
                         + ledger.work() + ledger.mass() + ledger.work_of_loads()
                         + ledger.exchanged_work());
}

/// What a side holds beyond all that passed into it, interface apart, J/m.
double unexplained_heat(const v1::Ledger& ledger) {
    return ledger.heat() - ledger.heat_from_walls() - ledger.heat_from_sources();
}

} // namespace

Audit::Audit(v1::Coupling::Schedule schedule, double tolerance)
    : in_flight_(schedule != v1::Coupling::FLUID_FIRST),
      work_behind_(schedule != v1::Coupling::SOLID_FIRST), tolerance_(tolerance) {}

void Audit::start(const v1::Ledger* solid, const v1::Ledger* fluid) {
    if (solid)
        solid_start_ = solid_before_ = *solid;
    if (fluid)
        fluid_start_ = fluid_before_ = *fluid;
}

std::optional<std::string> Audit::window(const v1::Ledger* solid, const v1::Ledger* fluid) {
    for (const v1::Ledger* ledger : {solid, fluid})
        if (ledger && !finite(*ledger))
            return std::string("the ledger of the ") + (ledger == solid ? "solid" : "fluid")
                   + " holds a number that is not finite";
    std::optional<std::string> broken;
    if (solid && fluid) {
        broken = compare(*solid, in_flight_ ? *fluid_before_ : *fluid);
        if (!broken)
            broken = compare_work(work_behind_ ? *solid_before_ : *solid, *fluid);
    }
    follow_heat(solid, fluid);
    if (solid) {
        follow_mass(*solid_start_, *solid);
        solid_before_ = *solid;
    }
    if (fluid) {
        follow_mass(*fluid_start_, *fluid);
        fluid_before_ = *fluid;
    }
    return broken;
}

std::optional<std::string> Audit::compare(const v1::Ledger& solid, const v1::Ledger& fluid) {
    const double heat_scale = std::max(solid.exchanged_heat(), fluid.exchanged_heat());
    const double heat =
        imbalance(solid.heat_from_interface(), fluid.heat_from_interface(), heat_scale);
    const double impulse_scale = std::max(solid.exchanged_impulse(), fluid.exchanged_impulse());
    const double impulse = std::max(imbalance(solid.impulse_x(), fluid.impulse_x(), impulse_scale),
                                    imbalance(solid.impulse_y(), fluid.impulse_y(), impulse_scale));
    found_.heat = std::max(found_.heat, heat);
    found_.impulse = std::max(found_.impulse, impulse);
    // Predicted motion and frozen loads part what the two sides themselves saw, by the order of a
    // window: reported, not judged.
    found_.work_difference = imbalance(
        solid.work(), fluid.work(), std::max(std::abs(solid.work()), std::abs(fluid.work())));

    const auto sentence = [&](const std::string& what, double a, double b, double found) {
        return what + " does not balance: the solid booked " + number_text(a) + ", the fluid "
               + number_text(b) + "; of all exchanged this is " + number_text(found)
               + ", allowed is " + number_text(tolerance_);
    };
    if (!(heat <= tolerance_))
        return sentence("heat through the interface",
                        solid.heat_from_interface(),
                        fluid.heat_from_interface(),
                        heat);
    if (!(impulse <= tolerance_))
        return sentence("impulse through the interface",
                        std::hypot(solid.impulse_x(), solid.impulse_y()),
                        std::hypot(fluid.impulse_x(), fluid.impulse_y()),
                        impulse);
    return std::nullopt;
}

/// The work of a load is what the solid booked for it, in the motion that came back to the fluid.
/// Positions are rounded on the way, and a solid may book from its velocities: more than that
/// rounding is a load or a motion that was not the one sent.
std::optional<std::string> Audit::compare_work(const v1::Ledger& solid, const v1::Ledger& fluid) {
    constexpr double rounding = 1e-9;
    const double work = imbalance(solid.work(), -fluid.work_of_loads(), fluid.exchanged_work());
    found_.work = std::max(found_.work, work);
    if (work <= std::max(tolerance_, rounding))
        return std::nullopt;
    return "work through the interface does not balance: the solid booked "
           + number_text(solid.work()) + " J/m, the loads sent did "
           + number_text(fluid.work_of_loads()) + " J/m in the motion received";
}

void Audit::follow_heat(const v1::Ledger* solid, const v1::Ledger* fluid) {
    double residual = 0;
    double scale = 0;
    for (const v1::Ledger* ledger : {solid, fluid}) {
        if (!ledger)
            continue;
        residual += unexplained_heat(*ledger);
        // What is still under way was booked by the fluid and not yet by the solid.
        if (in_flight_ || !solid || !fluid)
            residual -= ledger->heat_from_interface();
        // What one wall gives and another takes is exchanged, whatever is left of it in sum.
        const auto through_walls = ledger->figure().find("heat_through_walls");
        scale = std::max({scale,
                          ledger->exchanged_heat(),
                          through_walls == ledger->figure().end() ? 0 : through_walls->second,
                          std::abs(ledger->heat_from_walls()),
                          std::abs(ledger->heat_from_sources())});
    }
    heat_residual_ = std::max(heat_residual_, std::abs(residual));
    heat_scale_ = std::max(heat_scale_, scale);
}

void Audit::follow_mass(const v1::Ledger& start, const v1::Ledger& now) {
    found_.mass_drift =
        std::max(found_.mass_drift, imbalance(now.mass(), -start.mass(), std::abs(start.mass())));
}

Balances Audit::balances() const {
    Balances out = found_;
    out.total_heat_drift = heat_residual_ == 0 ? 0 : heat_residual_ / heat_scale_;
    return out;
}

} // namespace duet::orchestrator
