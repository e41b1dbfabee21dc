#include "fluid_solver/particles.hpp"

#include "fluid_solver/chunks.hpp"

#include <cmath>

namespace duet::fluid {

CellGrid::CellGrid(Vec2 lower, Vec2 upper, double cell, Periodic periodic) : lower_(lower) {
    const auto divide = [cell](bool repeats,
                               double from,
                               double length,
                               double& period,
                               double& origin,
                               double& side,
                               int& count) {
        const int inner = repeats ? std::max(1, static_cast<int>(length / cell))
                                  : static_cast<int>(std::ceil(length * (1 / cell))) + 1;
        period = repeats ? length : 0;
        side = repeats ? length / inner : cell;
        origin = from - (repeats ? 1 : 1.5) * side;
        count = inner + 2;
    };
    const Vec2 size = upper - lower;
    divide(periodic.x, lower.x, size.x, period_.x, origin_.x, cell_.x, columns_);
    divide(periodic.y, lower.y, size.y, period_.y, origin_.y, cell_.y, rows_);
    inverse_ = {1 / cell_.x, 1 / cell_.y};
}

void Particles::resize(std::size_t n) {
    x.resize(n);
    y.resize(n);
    fields.resize(n);
    relaxing.resize(n);
    rate.resize(n);
    identity.resize(n);
    compartment.resize(n);
}

namespace {

template <class T>
void reorder(std::vector<T>& values,
             std::vector<T>& spare,
             const std::vector<std::uint32_t>& to,
             int threads) {
    spare.resize(values.size());
    for_particles(values.size(), threads, [&](std::size_t i) { spare[to[i]] = values[i]; });
    values.swap(spare);
}

} // namespace

void Particles::sort(const CellGrid& grid, int threads) {
    const std::size_t n = size();
    cell_.resize(n);
    target_.resize(n);
    cell_start_.assign(grid.size() + 1, 0);
    for_particles(n, threads, [&](std::size_t i) {
        cell_[i] = static_cast<std::uint32_t>(grid.index(position(i)));
    });
    for (std::size_t i = 0; i < n; ++i) {
        ++cell_start_[cell_[i] + 1];
    }
    for (std::size_t c = 0; c < grid.size(); ++c) {
        cell_start_[c + 1] += cell_start_[c];
    }
    // Each particle takes the next free place of its cell; the starts are shifted back afterwards.
    for (std::size_t i = 0; i < n; ++i) {
        target_[i] = cell_start_[cell_[i]]++;
    }
    for (std::size_t c = grid.size(); c > 0; --c) {
        cell_start_[c] = cell_start_[c - 1];
    }
    cell_start_[0] = 0;
    reorder(x, spare_, target_, threads);
    reorder(y, spare_, target_, threads);
    reorder(fields, spare_fields_, target_, threads);
    reorder(relaxing, spare_relaxing_, target_, threads);
    reorder(rate, spare_slope_, target_, threads);
    reorder(laplacian, spare_slope_, target_, threads);
    reorder(identity, spare_identity_, target_, threads);
    reorder(compartment, spare_compartment_, target_, threads);
}

} // namespace duet::fluid
