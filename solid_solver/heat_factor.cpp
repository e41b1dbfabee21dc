#include "solid_solver/heat_factor.hpp"

namespace duet::solid {

void HeatFactor::prepare(const Heat& heat, double tau) {
    if (tau == tau_) {
        return;
    }
    tau_ = tau;
    const auto nodes = static_cast<Eigen::Index>(heat.capacity().size());
    prescribed_.clear();
    std::vector<bool> held(heat.capacity().size(), false);
    heat.for_prescribed([&](std::uint32_t node, double) {
        prescribed_.push_back(node);
        held[node] = true;
    });
    Eigen::VectorXd diagonal(nodes);
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < nodes; ++i) {
        diagonal[i] = heat.capacity()[static_cast<std::size_t>(i)];
    }
    heat.conduction().for_pairs([&](std::uint32_t i, std::uint32_t j, double conductance) {
        diagonal[i] += tau * conductance;
        diagonal[j] += tau * conductance;
        if (!held[i] && !held[j]) {
            entries.emplace_back(i, j, -tau * conductance);
        }
    });
    heat.for_exchange(
        [&](std::uint32_t node, double coefficient) { diagonal[node] += tau * coefficient; });
    for (Eigen::Index i = 0; i < nodes; ++i) {
        entries.emplace_back(i, i, held[static_cast<std::size_t>(i)] ? 1 : diagonal[i]);
    }
    Eigen::SparseMatrix<double> matrix(nodes, nodes);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factor_.compute(matrix);
}

void HeatFactor::solve(Eigen::VectorXd& nodal) const {
    for (const std::uint32_t node : prescribed_) {
        nodal[node] = 0;
    }
    nodal = factor_.solve(nodal);
}

} // namespace duet::solid
