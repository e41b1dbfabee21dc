// The checks of a scene, for the files scene_check*.cpp alone, one for each part of the scene.

#pragma once

#include "orchestrator/case_file.hpp"
#include "orchestrator/geometry.hpp"
#include "orchestrator/schema.hpp"
#include "solid_solver/mesh.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace duet::orchestrator {

/// The path of the entry number i of an array.
std::string entry(const std::string& path, int i);

/// The point as a case file has it.
std::string at_text(const Point& p);

/// The end of the run, but for rounding.
double latest(const v1::Scene& scene);

/// True if the end of the run was given on the command line.
bool shortened(const Case& given);

/// The boundary tells the motion along x, or along y.
bool tells_motion(const v1::Boundary& boundary, bool along_x);

class Checker {
  public:
    explicit Checker(const Case& given);

    /// Every problem found, in the scene's order.
    std::vector<Problem> run();

  private:
    void problem(const std::string& path, const std::string& sentence);
    void check_interval(const std::string& path, double interval);
    void check_size(double count, const std::string& what, const std::string& path);
    void steady_in_place(const v1::Function& function, const std::string& path);

    void check_fluid();
    void check_initial_state();
    void check_periodic();
    void check_clear_of_seams(const v1::Body& body, const std::string& path);
    bool check_seams(const v1::Wall& wall, const std::string& path);
    void check_hole(const v1::Hole& hole, const std::string& path);
    void check_wall(const v1::Wall& wall, const std::string& path);
    Polygon outline_of(const std::string& around) const;
    void check_slip(const v1::Wall& wall, const std::string& path);
    void check_sharing(const v1::Wall& wall, const std::string& path);

    void check_bodies();
    void check_body(const v1::Body& body, const std::string& path);
    void check_motion(const v1::Body& body, const std::string& path);
    void check_point_loads(const v1::Body& body, const std::string& path);
    void check_shape(const v1::Body& body, const std::string& path);
    void check_rectangle(const v1::Body& body, const std::string& path);
    void check_mesh(const v1::Body& body, const solid::Mesh& mesh, const std::string& path);
    std::vector<std::string> curves_of(const v1::Body& body) const;
    void
    check_boundary(const v1::Boundary& boundary, const v1::Body& body, const std::string& path);
    void
    check_conditions(const v1::Boundary& boundary, const v1::Body& body, const std::string& path);
    void check_leaning(const v1::Body& body, const std::string& path);

    void check_probe(const v1::Probe& probe, const std::string& path);
    void check_probed_boundary(const v1::Probe& probe, const std::string& path);
    bool holds(const v1::Body& body, const Point& p, bool otherwise) const;
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

    const Case& case_;
    const v1::Scene& scene_;
    std::map<const v1::Body*, solid::Mesh> mesh_; // of .msh files that can be computed with
    Polygon region_;
    double tolerance_ = 0;
    bool region_good_ = false;
    std::vector<Problem> problems_;
};

} // namespace duet::orchestrator
