// What is recorded, and what it is held against: probes and checks.

#include "orchestrator/scene_checker.hpp"

#include "orchestrator/figures.hpp"
#include "orchestrator/reference_table.hpp"
#include "orchestrator/schema.hpp"
#include "solid_solver/locator.hpp"

#include <algorithm>

namespace duet::orchestrator {

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

} // namespace duet::orchestrator
