#include "solid_solver/stiffness.hpp"

#include <algorithm>
#include <set>

namespace duet::solid {

namespace {

constexpr std::size_t slots = Domains::slots;

/// Calls visit(pair, s, t) for each pair of slots s <= t of a domain that holds two filled slots.
template <class Visit>
void for_pairs(const std::array<std::uint32_t, slots>& node, const Visit& visit) {
    std::size_t pair = 0;
    for (std::size_t s = 0; s < slots; ++s) {
        for (std::size_t t = s; t < slots; ++t, ++pair) {
            const bool filled = t == 0 || node[t] != node[0];
            if (filled) {
                visit(pair, s, t);
            }
        }
    }
}

} // namespace

Stiffness::Stiffness(const Mechanics& mechanics) {
    const Domains& domains = mechanics.elasticity().domains();
    const std::size_t nodes = domains.first.size() - 1;
    held_.resize(2 * nodes);
    for (std::size_t c = 0; c < held_.size(); ++c) {
        held_[c] = mechanics.inverse_mass()[c] == 0;
    }
    // The lower neighbours of each node J, those I >= J that it shares a domain with.
    std::vector<std::set<std::uint32_t>> below(nodes);
    for (const auto& node : domains.node) {
        for_pairs(node, [&](std::size_t, std::size_t s, std::size_t t) {
            below[std::min(node[s], node[t])].insert(std::max(node[s], node[t]));
        });
    }
    std::vector<Eigen::Triplet<double>> entries;
    for (std::uint32_t j = 0; j < nodes; ++j) {
        for (const std::uint32_t i : below[j]) {
            for (std::uint32_t d = 0; d < 2; ++d) {
                for (std::uint32_t c = 0; c < 2; ++c) {
                    if (i != j || d >= c) {
                        entries.emplace_back(2 * i + d, 2 * j + c, 0.0);
                    }
                }
            }
        }
    }
    const auto size = static_cast<Eigen::Index>(2 * nodes);
    matrix_.resize(size, size);
    matrix_.setFromTriplets(entries.begin(), entries.end());
    const auto place = [&](std::uint32_t row, std::uint32_t column) {
        const int* inner = matrix_.innerIndexPtr();
        const int* end = inner + matrix_.outerIndexPtr()[column + 1];
        return static_cast<int>(
            std::lower_bound(inner + matrix_.outerIndexPtr()[column], end, static_cast<int>(row))
            - inner);
    };
    place_.resize(domains.size());
    for (std::size_t k = 0; k < domains.size(); ++k) {
        const auto& node = domains.node[k];
        for_pairs(node, [&](std::size_t pair, std::size_t s, std::size_t t) {
            const std::uint32_t i = std::max(node[s], node[t]), j = std::min(node[s], node[t]);
            // On the diagonal the second column starts with its own diagonal entry.
            place_[k][pair] = {place(2 * i, 2 * j), place(2 * i + (i == j), 2 * j + 1)};
        });
    }
    factor_.analyzePattern(matrix_);
}

void Stiffness::add(const Mechanics& mechanics, std::size_t k, const Parts& parts) {
    const Elasticity& elasticity = mechanics.elasticity();
    const Elasticity::Linearised l = elasticity.linearised(k);
    const auto &gx = l.shape.x, &gy = l.shape.y;
    const double fxx = 1 + l.g.xx, fyy = 1 + l.g.yy, fxy = l.g.xy, fyx = l.g.yx;
    const double cross = parts.material * (l.lambda + parts.adiabatic * l.warming);
    const double shear = parts.material * l.mu, stiff = cross + 2 * shear;
    // Rows of B for each slot: E_xx, E_yy, 2 E_xy by a displacement of the node along x and y.
    std::array<Eigen::Matrix<double, 3, 2>, slots> b, db;
    for (std::size_t s = 0; s < slots; ++s) {
        const double x = gx[s], y = gy[s];
        b[s] << fxx * x, fyx * x, fxy * y, fyy * y, fxx * y + fxy * x, fyx * y + fyy * x;
        db[s].row(0) = stiff * b[s].row(0) + cross * b[s].row(1);
        db[s].row(1) = cross * b[s].row(0) + stiff * b[s].row(1);
        db[s].row(2) = shear * b[s].row(2);
    }
    const auto& node = elasticity.domains().node[k];
    double* value = matrix_.valuePtr();
    for_pairs(node, [&](std::size_t pair, std::size_t s, std::size_t t) {
        const std::size_t row = node[s] >= node[t] ? s : t, column = node[s] >= node[t] ? t : s;
        const double geometric = gx[row] * (l.stress.xx * gx[column] + l.stress.xy * gy[column])
                                 + gy[row] * (l.stress.xy * gx[column] + l.stress.yy * gy[column]);
        Eigen::Matrix2d block = b[row].transpose() * db[column];
        block.diagonal().array() += geometric;
        block *= l.shape.area;
        for (std::size_t c = 0; c < 2; ++c) {
            for (std::size_t d = s == t ? c : 0; d < 2; ++d) {
                if (!held_[2 * node[row] + d] && !held_[2 * node[column] + c]) {
                    const auto from = static_cast<int>(s == t ? d - c : d);
                    value[place_[k][pair][c] + from] +=
                        block(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(c));
                }
            }
        }
    });
}

bool Stiffness::factorise(const Mechanics& mechanics, const Parts& parts) {
    std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), 0.0);
    for (std::size_t k = 0; k < place_.size(); ++k) {
        add(mechanics, k, parts);
    }
    for (std::size_t c = 0; c < held_.size(); ++c) { // the diagonal leads its column
        matrix_.valuePtr()[matrix_.outerIndexPtr()[c]] +=
            held_[c] ? 1 : parts.mass * mechanics.mass()[c / 2];
    }
    factor_.factorize(matrix_);
    return factor_.info() == Eigen::Success && factor_.vectorD().minCoeff() > 0;
}

void Stiffness::solve(const Eigen::VectorXd& right, Eigen::VectorXd& x) const {
    x = factor_.solve(right);
}

} // namespace duet::solid
