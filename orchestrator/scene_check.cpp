#include "orchestrator/scene_check.hpp"

#include "orchestrator/mesh_body.hpp"
#include "orchestrator/scene_checker.hpp"
#include "protocol/function.hpp"

#include <algorithm>
#include <cmath>

namespace duet::orchestrator {

std::string entry(const std::string& path, int i) {
    return path + "[" + std::to_string(i) + "]";
}

std::string at_text(const Point& p) {
    return "[" + number_text(p.x()) + ", " + number_text(p.y()) + "]";
}

double latest(const v1::Scene& scene) {
    return scene.time().end() * (1 + 1e-12);
}

bool shortened(const Case& given) {
    return given.overridden.contains("time.end");
}

Checker::Checker(const Case& given) : case_(given), scene_(given.scene) {
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

std::vector<Problem> Checker::run() {
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

/// So many records would fill memory and disk before the run has an end.
void Checker::check_interval(const std::string& path, double interval) {
    constexpr double most = 1e6;
    if (interval > 0 && scene_.time().end() / interval > most)
        problem(path,
                path + " asks for more than a million records until time.end; make it longer");
}

void Checker::problem(const std::string& path, const std::string& sentence) {
    problems_.push_back({case_.places.find(path), sentence});
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
