// The case file: read once, checked whole, turned into the scene that the solvers get.
//
// Every key is declared once, as a field of scene.proto; the reader walks the descriptors, so this
// room knows how a case file is spelt but not one of its keys.

#pragma once

#include "duet/v1/scene.pb.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace duet::orchestrator {

/// Where a key was written: the case file, or the text of a --set (line 0).
struct Place {
    std::string source;
    std::size_t line = 0;
    std::size_t column = 0;
};

/// One thing that is wrong with a case, as a sentence.
struct Problem {
    Place place;
    std::string sentence;
    /// "case.toml:12:5: sentence"
    std::string text() const;
};

/// A case that cannot be run; what() holds all problems, one a line, in the order of the file.
class CaseError : public std::runtime_error {
  public:
    explicit CaseError(std::vector<Problem> problems);
    const std::vector<Problem>& problems() const { return problems_; }

  private:
    std::vector<Problem> problems_;
};

/// Every key by its path ("solid.body[0].rectangle") and where it was written.
class Places {
  public:
    void add(const std::string& path, const Place& place) { places_[path] = place; }
    /// The place of the key or, if it was not written, of the nearest table round it.
    Place find(const std::string& path) const;

  private:
    std::map<std::string, Place> places_;
};

struct Case {
    v1::Scene scene;              ///< complete: every default filled in; paths of files absolute
    std::filesystem::path file;   ///< the case file
    std::filesystem::path folder; ///< absolute, where it lies
    std::string name;             ///< of the folder; of the file, if it is not called case.toml
    Places places;
    std::set<std::string> overridden; ///< keys given by --set
};

/// Reads a case: a folder that holds case.toml, or a file. `overrides` are texts
/// "solid.body[0].element_size=0.1", the value as in TOML. Checks keys, types, ranges, counts,
/// choices and files, not the scene as a whole (scene_check.hpp). Throws CaseError with every
/// problem found.
Case read_case(const std::filesystem::path& where, const std::vector<std::string>& overrides = {});

/// The same from text, for a case that lies in `folder`.
Case parse_case(const std::string& text,
                const std::filesystem::path& file,
                const std::vector<std::string>& overrides = {});

/// The scene as a case file with every key written out, each with its help and unit as a comment;
/// reading it gives an equal scene.
std::string write_case(const v1::Scene& scene);

/// docs/case-file.md: every table and key of scene.proto.
std::string case_file_reference();

} // namespace duet::orchestrator
