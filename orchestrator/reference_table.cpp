#include "orchestrator/reference_table.hpp"

#include "orchestrator/schema.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace duet::orchestrator {

namespace {

std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> out;
    std::istringstream stream(line);
    std::string cell;
    while (std::getline(stream, cell, ',')) {
        const std::size_t first = cell.find_first_not_of(" \t\r");
        const std::size_t last = cell.find_last_not_of(" \t\r");
        out.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
    }
    return out;
}

} // namespace

ReferenceTable::ReferenceTable(const std::filesystem::path& file) : file_(file) {
    std::ifstream stream(file);
    if (!stream)
        throw std::runtime_error(file.string() + ": cannot be read");
    std::string line;
    for (std::size_t number = 1; std::getline(stream, line); ++number) {
        const std::vector<std::string> row = cells(line);
        if (row.empty() || line.front() == '#')
            continue;
        if (names_.empty()) {
            names_ = row;
            columns_.resize(row.size());
            continue;
        }
        const std::string at = file.string() + ":" + std::to_string(number) + ": ";
        if (row.size() != names_.size())
            throw std::runtime_error(at + "expected " + std::to_string(names_.size())
                                     + " numbers, found " + std::to_string(row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) {
            std::size_t read = 0;
            try {
                columns_[i].push_back(std::stod(row[i], &read));
            } catch (const std::logic_error&) {
                read = 0;
            }
            if (read == 0 || read != row[i].size())
                throw std::runtime_error(at + "'" + row[i] + "' is not a number");
        }
    }
    if (names_.empty() || columns_[0].empty())
        throw std::runtime_error(file.string()
                                 + ": expected a line of column names and one of "
                                   "numbers at least");
}

bool ReferenceTable::has(const std::string& name) const {
    return std::find(names_.begin(), names_.end(), name) != names_.end();
}

const std::vector<double>& ReferenceTable::column(const std::string& name) const {
    if (name.empty())
        return columns_[0];
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end())
        throw std::runtime_error(file_.string() + ": no column '" + name + "'; there are "
                                 + list(names_, "and"));
    return columns_[static_cast<std::size_t>(found - names_.begin())];
}

double ReferenceTable::interpolate(const std::string& column_name,
                                   const std::string& along,
                                   double at) const {
    const std::vector<double>& x = column(along);
    const std::vector<double>& y = column(column_name);
    const double slack = 1e-9 * std::max(std::abs(x.front()), std::abs(x.back()));
    if (!(at >= x.front() - slack && at <= x.back() + slack))
        throw std::runtime_error(file_.string() + ": " + number_text(at) + " lies outside "
                                 + number_text(x.front()) + " to " + number_text(x.back())
                                 + ", which the reference covers");
    const auto after = std::lower_bound(x.begin(), x.end(), at);
    if (after == x.begin())
        return y.front();
    if (after == x.end())
        return y.back();
    const auto i = static_cast<std::size_t>(after - x.begin());
    const double weight = (at - x[i - 1]) / (x[i] - x[i - 1]);
    return y[i - 1] + weight * (y[i] - y[i - 1]);
}

} // namespace duet::orchestrator
