#include "fluid_solver/particles.hpp"

#include <cmath>

namespace duet::fluid {

CellGrid::CellGrid(Vec2 lower, Vec2 upper, double cell) : cell_(cell), inverse_(1 / cell) {
    columns_ = static_cast<int>(std::ceil((upper.x - lower.x) * inverse_)) + 3;
    rows_ = static_cast<int>(std::ceil((upper.y - lower.y) * inverse_)) + 3;
    origin_ = lower - Vec2{1.5 * cell, 1.5 * cell};
}

void Particles::resize(std::size_t n) {
    x.resize(n);
    y.resize(n);
    fields.resize(n);
    identity.resize(n);
    compartment.resize(n);
}

namespace {

template <class T>
void reorder(std::vector<T>& values, std::vector<T>& spare, const std::vector<std::uint32_t>& to) {
    spare.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        spare[to[i]] = values[i];
    }
    values.swap(spare);
}

} // namespace

void Particles::sort(const CellGrid& grid) {
    const std::size_t n = size();
    cell_.resize(n);
    target_.resize(n);
    cell_start_.assign(grid.size() + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
        cell_[i] = static_cast<std::uint32_t>(grid.index(position(i)));
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
    reorder(x, spare_, target_);
    reorder(y, spare_, target_);
    reorder(fields, spare_fields_, target_);
    reorder(identity, spare_identity_, target_);
    reorder(compartment, spare_compartment_, target_);
}

} // namespace duet::fluid
