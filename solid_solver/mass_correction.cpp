#include "solid_solver/mass_correction.hpp"

#include "solid_solver/parallel.hpp"

#include <map>

namespace duet::solid {

MassCorrection::MassCorrection(const Mesh& mesh, const std::vector<double>& density) {
    std::vector<std::map<std::uint32_t, double>> row(mesh.node.size());
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
        const Triangle& node = mesh.triangle[t];
        const double mass = density[mesh.part_of(t)] * triangle_area(mesh, node) / 12;
        for (std::size_t i = 0; i < 3; ++i) {
            row[node[i]][node[(i + 1) % 3]] += mass;
            row[node[i]][node[(i + 2) % 3]] += mass;
        }
    }
    first_.push_back(0);
    for (const auto& pairs : row) {
        for (const auto& [neighbour, mass] : pairs) {
            neighbour_.push_back(neighbour);
            mass_.push_back(mass);
        }
        first_.push_back(static_cast<std::uint32_t>(neighbour_.size()));
    }
}

void MassCorrection::apply(std::span<const double> acceleration,
                           std::span<const double> inverse_mass,
                           std::span<double> out,
                           int threads) const {
    in_pieces(first_.size() - 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double ax = acceleration[2 * i], ay = acceleration[2 * i + 1];
            double x = 0, y = 0;
            for (std::uint32_t j = first_[i]; j < first_[i + 1]; ++j) {
                x += mass_[j] * (ax - acceleration[2 * neighbour_[j]]);
                y += mass_[j] * (ay - acceleration[2 * neighbour_[j] + 1]);
            }
            out[2 * i] = ax + inverse_mass[2 * i] * x;
            out[2 * i + 1] = ay + inverse_mass[2 * i + 1] * y;
        }
    });
}

} // namespace duet::solid
