// A reference: columns of numbers in a CSV file.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace duet::orchestrator {

/// Lines that start with '#' are comments; the first other line names the columns.
class ReferenceTable {
  public:
    /// Throws std::runtime_error with file, line, and what was expected.
    explicit ReferenceTable(const std::filesystem::path& file);

    const std::vector<std::string>& names() const { return names_; }
    bool has(const std::string& name) const;
    /// The column; the first one for an empty name.
    const std::vector<double>& column(const std::string& name) const;

    /// The value of `column` where `along` is `at`, linear between rows. `along` must ascend.
    /// Throws std::runtime_error if `at` lies outside the table.
    double interpolate(const std::string& column, const std::string& along, double at) const;

  private:
    std::filesystem::path file_;
    std::vector<std::string> names_;
    std::vector<std::vector<double>> columns_;
};

} // namespace duet::orchestrator
