// The folder that keeps all of a run.

#pragma once

#include <filesystem>
#include <string>

namespace duet::orchestrator {

class RunFolder {
  public:
    /// Creates `path` and locks it until the end. Refuses, with std::runtime_error, a folder that
    /// another run is using, and one that holds anything unless `overwrite` (which then empties it,
    /// if it holds a run).
    RunFolder(const std::filesystem::path& path, bool overwrite);
    ~RunFolder();
    RunFolder(const RunFolder&) = delete;
    RunFolder& operator=(const RunFolder&) = delete;

    /// Absolute.
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path file(const std::string& name) const { return path_ / name; }

    /// Writes the file aside and renames it: a reader sees the old or the new, never a half.
    void write(const std::string& name, const std::string& text) const;

  private:
    std::filesystem::path path_;
    int lock_ = -1;
};

/// runs/<case>-<date>-<time> under the current folder; with a number behind it if that exists.
std::filesystem::path default_run_folder(const std::string& case_name);

} // namespace duet::orchestrator
