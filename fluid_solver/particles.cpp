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

/// Calls visit(values, spare) for each array.
template <class Visit>
void Particles::for_arrays(const Visit& visit) {
    visit(x, spare_.x);
    visit(y, spare_.y);
    visit(fields, spare_.fields);
    visit(relaxing, spare_.relaxing);
    visit(rate, spare_.rate);
    visit(laplacian, spare_.laplacian);
    visit(identity, spare_.identity);
    visit(compartment, spare_.compartment);
}

/// Each thread counts and moves a range of the particles; in a cell the ranges follow one another.
void Particles::sort(const CellGrid& grid, int threads) {
    const std::size_t n = size(), cells = grid.size();
    const std::size_t ranges = stretches_of(threads);
    cell_.resize(n);
    next_.resize(ranges * cells);
    for_ranges(n, threads, [&](std::size_t range, std::size_t first, std::size_t last) {
        std::uint32_t* count = &next_[range * cells];
        std::fill_n(count, cells, 0);
        for (std::size_t i = first; i < last; ++i) {
            cell_[i] = static_cast<std::uint32_t>(grid.index(position(i)));
            ++count[cell_[i]];
        }
    });
    cell_start_.resize(cells + 1);
    std::uint32_t before = 0;
    for (std::size_t c = 0; c < cells; ++c) {
        cell_start_[c] = before;
        for (std::size_t range = 0; range < ranges; ++range) {
            before += std::exchange(next_[range * cells + c], before);
        }
    }
    cell_start_[cells] = before;
    for_arrays([](auto& values, auto& spare) { spare.resize(values.size()); });
    for_ranges(n, threads, [&](std::size_t range, std::size_t first, std::size_t last) {
        std::uint32_t* next = &next_[range * cells];
        std::vector<std::uint32_t>& to = cell_;
        for (std::size_t i = first; i < last; ++i) {
            to[i] = next[cell_[i]]++;
        }
        for_arrays([&](auto& values, auto& spare) {
            for (std::size_t i = first; i < last && !values.empty(); ++i) {
                spare[to[i]] = values[i];
            }
        });
    });
    for_arrays([](auto& values, auto& spare) { values.swap(spare); });
}

} // namespace duet::fluid
