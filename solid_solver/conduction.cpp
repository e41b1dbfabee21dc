#include "solid_solver/conduction.hpp"

#include <algorithm>
#include <cmath>

namespace duet::solid {

namespace {

struct Term {
    std::uint32_t row, column;
    double value;
};

/// The upper triangle of -K, equal pairs summed in the order of the domains.
std::vector<Term> upper_conductances(const Domains& domains,
                                     const std::vector<double>& conductivity) {
    std::vector<Term> terms;
    terms.reserve(6 * domains.size());
    for (std::size_t k = 0; k < domains.size(); ++k) {
        const auto& node = domains.node[k];
        const auto &x = domains.gradient_x[k], &y = domains.gradient_y[k];
        const double factor = domains.area[k] * conductivity[domains.part[k]];
        for (std::size_t s = 0; s < Domains::slots; ++s) {
            for (std::size_t t = s + 1; t < Domains::slots; ++t) {
                if (node[s] != node[t]) {
                    terms.push_back({std::min(node[s], node[t]),
                                     std::max(node[s], node[t]),
                                     -factor * (x[s] * x[t] + y[s] * y[t])});
                }
            }
        }
    }
    std::stable_sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) {
        return a.row != b.row ? a.row < b.row : a.column < b.column;
    });
    std::vector<Term> sums;
    for (const Term& term : terms) {
        if (!sums.empty() && sums.back().row == term.row && sums.back().column == term.column) {
            sums.back().value += term.value;
        } else {
            sums.push_back(term);
        }
    }
    return sums;
}

} // namespace

Conduction::Conduction(const Domains& domains, const std::vector<double>& conductivity) {
    std::vector<Term> upper = upper_conductances(domains, conductivity);
    double largest = 0;
    for (const Term& term : upper) {
        largest = std::max(largest, std::abs(term.value));
    }
    // On regular meshes many pairs cancel but for rounding; they would only cost time.
    std::erase_if(upper, [&](const Term& t) { return std::abs(t.value) <= 1e-14 * largest; });

    const std::size_t nodes = domains.first.size() - 1;
    first_.assign(nodes + 1, 0);
    for (const Term& term : upper) {
        ++first_[term.row + 1];
        ++first_[term.column + 1];
    }
    for (std::size_t i = 0; i < nodes; ++i) {
        first_[i + 1] += first_[i];
    }
    neighbour_.resize(first_[nodes]);
    conductance_.resize(first_[nodes]);
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    const auto put = [&](std::uint32_t row, std::uint32_t column, double value) {
        neighbour_[next[row]] = column;
        conductance_[next[row]++] = value;
    };
    // Lower neighbours first: `upper` is sorted by row, so each list comes out ascending.
    for (const Term& term : upper) {
        put(term.column, term.row, term.value);
    }
    for (const Term& term : upper) {
        put(term.row, term.column, term.value);
    }
}

void Conduction::advance(const double* temperature,
                         const double* rate,
                         const double* factor,
                         double* out,
                         std::size_t begin,
                         std::size_t end) const {
    const std::uint32_t* neighbour = neighbour_.data();
    const double* conductance = conductance_.data();
    for (std::size_t i = begin; i < end; ++i) {
        const double own = temperature[i];
        double sum = rate[i];
        for (std::uint32_t j = first_[i]; j < first_[i + 1]; ++j) {
            sum += conductance[j] * (temperature[neighbour[j]] - own);
        }
        out[i] = own + factor[i] * sum;
    }
}

void Conduction::flow(const double* temperature, double* out) const {
    for (std::size_t i = 0; i < nodes(); ++i) {
        double sum = 0;
        for (std::uint32_t j = first_[i]; j < first_[i + 1]; ++j) {
            sum += conductance_[j] * (temperature[neighbour_[j]] - temperature[i]);
        }
        out[i] = sum;
    }
}

} // namespace duet::solid
