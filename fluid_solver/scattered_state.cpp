#include "fluid_solver/scattered_state.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

namespace duet::fluid {

namespace {

/// The words between commas, without the quotes and the space round them; a comma at the end opens
/// no further word.
std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> words(1);
    bool quoted = false;
    for (const char c : line) {
        if (c == '"') {
            quoted = !quoted;
        } else if (c == ',' && !quoted) {
            words.emplace_back();
        } else {
            words.back() += c;
        }
    }
    for (std::string& word : words) {
        const auto first = word.find_first_not_of(" \t\r"), last = word.find_last_not_of(" \t\r");
        word = first == std::string::npos ? "" : word.substr(first, last - first + 1);
    }
    if (words.back().empty()) {
        words.pop_back();
    }
    return words;
}

double number(const std::string& word, const std::string& where) {
    std::size_t used = 0;
    double value = 0;
    try {
        value = std::stod(word, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (used == 0 || used != word.size() || !std::isfinite(value)) {
        throw std::invalid_argument(where + ": '" + word + "' is no finite number");
    }
    return value;
}

} // namespace

ScatteredState::ScatteredState(const std::filesystem::path& file,
                               Periodic periodic,
                               Vec2 lower,
                               Vec2 upper) {
    read(file);
    sort(file);
    if (periodic.any()) {
        repeat(periodic, lower, upper);
        sort(file);
    }
}

/// Adds the images of the points that planes near a periodic side see over it.
void ScatteredState::repeat(Periodic periodic, Vec2 lower, Vec2 upper) {
    const double margin = 3 * cell_;
    const Vec2 period = upper - lower;
    const std::size_t count = points_.size();
    for (std::size_t i = 0; i < count; ++i) {
        for (const int along_x : {-1, 0, 1}) {
            for (const int along_y : {-1, 0, 1}) {
                const Vec2 p = points_[i] + Vec2{along_x * period.x, along_y * period.y};
                const bool meant = (along_x == 0 || periodic.x) && (along_y == 0 || periodic.y)
                                   && (along_x != 0 || along_y != 0);
                const bool near = p.x > lower.x - margin && p.x < upper.x + margin
                                  && p.y > lower.y - margin && p.y < upper.y + margin;
                if (meant && near) {
                    points_.push_back(p);
                    for (std::vector<double>& values : values_) {
                        if (!values.empty()) {
                            values.push_back(values[i]);
                        }
                    }
                }
            }
        }
    }
}

void ScatteredState::read(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) {
        throw std::invalid_argument(file.string() + ": the file cannot be opened");
    }
    std::vector<std::string> names;
    std::size_t x = 0, y = 0;
    std::array<std::size_t, 3> of{};
    int line_number = 0;
    for (std::string line; std::getline(in, line);) {
        ++line_number;
        const std::string where = file.string() + ", line " + std::to_string(line_number);
        if (line_number == 1 && line.starts_with("\xEF\xBB\xBF")) { // a mark that says UTF-8
            line.erase(0, 3);
        }
        const std::vector<std::string> words = split(line);
        if (words.empty() || line[0] == '#') {
            continue;
        }
        if (names.empty()) {
            names = words;
            const auto place = [&](const std::string& name) {
                return static_cast<std::size_t>(std::find(names.begin(), names.end(), name)
                                                - names.begin());
            };
            x = place("x");
            y = place("y");
            of = {place("temperature"), place("velocity_x"), place("velocity_y")};
            if (std::max(x, y) == names.size()
                || *std::min_element(of.begin(), of.end()) == names.size()) {
                throw std::invalid_argument(where
                                            + ": the columns x and y are needed, and at least one "
                                              "of temperature, velocity_x, velocity_y");
            }
            continue;
        }
        if (words.size() != names.size()) {
            throw std::invalid_argument(where + ": " + std::to_string(names.size())
                                        + " numbers are needed, one for each column");
        }
        points_.push_back({number(words[x], where), number(words[y], where)});
        for (std::size_t f = 0; f < of.size(); ++f) {
            if (of[f] < names.size()) {
                values_[f].push_back(number(words[of[f]], where));
            }
        }
    }
    if (names.empty()) {
        throw std::invalid_argument(file.string()
                                    + ": the file is empty; its first line names the columns");
    }
    if (points_.size() < 3) {
        throw std::invalid_argument(file.string() + ": a state needs at least three points");
    }
}

void ScatteredState::sort(const std::filesystem::path& file) {
    lower_ = points_[0];
    Vec2 upper = lower_;
    for (const Vec2 p : points_) {
        lower_ = {std::min(lower_.x, p.x), std::min(lower_.y, p.y)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
    }
    const Vec2 size = upper - lower_;
    const auto count = static_cast<double>(points_.size());
    cell_ = std::max(1.5 * std::sqrt(size.x * size.y / count),
                     1.5 * std::max(size.x, size.y) / count); // all on one line
    if (!(cell_ > 0)) {
        throw std::invalid_argument(file.string() + ": the points lie all at one place");
    }
    columns_ = static_cast<int>(size.x / cell_) + 1;
    rows_ = static_cast<int>(size.y / cell_) + 1;
    const auto cell_of = [&](Vec2 p) {
        return static_cast<std::size_t>(row(p.y)) * static_cast<std::size_t>(columns_)
               + static_cast<std::size_t>(column(p.x));
    };
    start_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (const Vec2 p : points_) {
        ++start_[cell_of(p) + 1];
    }
    for (std::size_t c = 1; c < start_.size(); ++c) {
        start_[c] += start_[c - 1];
    }
    order_.resize(points_.size());
    std::vector<std::uint32_t> next = start_;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        order_[next[cell_of(points_[i])]++] = i;
    }
}

int ScatteredState::column(double x) const {
    return std::clamp(static_cast<int>(std::floor((x - lower_.x) / cell_)), 0, columns_ - 1);
}
int ScatteredState::row(double y) const {
    return std::clamp(static_cast<int>(std::floor((y - lower_.y) / cell_)), 0, rows_ - 1);
}

double ScatteredState::nearest(Field field, Vec2 x) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < points_.size(); ++i) {
        if (norm(points_[i] - x) < norm(points_[best] - x)) {
            best = i;
        }
    }
    return values_[field][best];
}

double ScatteredState::at(Field field, Vec2 x) const {
    // Rings of cells are added until a plane is settled; on a lattice the first nine cells do.
    const int last = std::max(columns_, rows_);
    for (int reach = 1;; ++reach) {
        Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        double weight = 0, mean = 0;
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (int j = std::max(0, row(x.y) - reach); j <= std::min(rows_ - 1, row(x.y) + reach);
             ++j) {
            for (int i = std::max(0, column(x.x) - reach);
                 i <= std::min(columns_ - 1, column(x.x) + reach);
                 ++i) {
                const auto c = static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_)
                               + static_cast<std::size_t>(i);
                for (std::uint32_t k = start_[c]; k < start_[c + 1]; ++k) {
                    const Vec2 r = (1 / (reach * cell_)) * (points_[order_[k]] - x);
                    const double w = std::exp(-4 * dot(r, r)), f = values_[field][order_[k]];
                    const Eigen::Vector3d plane(1, r.x, r.y);
                    normal += w * plane * plane.transpose();
                    right += w * f * plane;
                    weight += w;
                    mean += w * f;
                    least = std::min(least, f);
                    most = std::max(most, f);
                }
            }
        }
        const Eigen::LDLT<Eigen::Matrix3d> factor(normal);
        if (weight > 0 && factor.rcond() > 1e-4) {
            return std::clamp(factor.solve(right)[0], least, most);
        }
        if (reach >= last) { // all points on one line, or so far away that their weights vanish
            return weight > 0 ? std::clamp(mean / weight, least, most) : nearest(field, x);
        }
    }
}

} // namespace duet::fluid
