#include "solid_solver/spectrum.hpp"

#include <Eigen/Eigenvalues>

namespace duet::solid {

/// In the variable M^(1/2) x, so that the matrix M^(-1/2) K M^(-1/2) is symmetric. Its largest
/// eigenvalue is the first to converge, long before rounding spoils the orthogonality.
double Spectrum::largest(const Operator& stiffness,
                         std::span<const double> inverse,
                         int most,
                         double tolerance) {
    using Vector = Eigen::VectorXd;
    const auto size = static_cast<Eigen::Index>(mode_.size());
    Vector root(size), x(size), image(size);
    for (Eigen::Index i = 0; i < size; ++i) {
        root[i] = std::sqrt(inverse[static_cast<std::size_t>(i)]);
    }
    Vector q =
        Eigen::Map<Vector>(mode_.data(), size)
            .cwiseProduct((root.array() > 0).select(1 / root.array().max(1e-300), 0).matrix());
    if (q.norm() == 0) {
        return 0; // everything is held
    }
    q.normalize();
    std::vector<Vector> basis;
    std::vector<double> diagonal, beside;
    double value = 0;
    Vector ritz;
    for (int round = 0; round < most; ++round) {
        basis.push_back(q);
        x = root.cwiseProduct(q);
        stiffness({x.data(), mode_.size()}, {image.data(), mode_.size()});
        q = root.cwiseProduct(image);
        diagonal.push_back(q.dot(basis.back()));
        q -= diagonal.back() * basis.back();
        if (round > 0) {
            q -= beside.back() * basis[basis.size() - 2];
        }
        const double rest = q.norm();
        const auto count = static_cast<Eigen::Index>(diagonal.size());
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small;
        small.computeFromTridiagonal(Eigen::Map<Vector>(diagonal.data(), count),
                                     Eigen::Map<Vector>(beside.data(), count - 1));
        value = small.eigenvalues()[count - 1];
        ritz = small.eigenvectors().col(count - 1);
        const double residual = rest * std::abs(ritz[count - 1]);
        if (value <= 0) {
            return 0;
        }
        if (residual <= tolerance * value || round + 1 == most || rest <= 1e-14 * value) {
            value += residual;
            break;
        }
        beside.push_back(rest);
        q /= rest;
    }
    x.setZero();
    for (std::size_t i = 0; i < basis.size(); ++i) {
        x += ritz[static_cast<Eigen::Index>(i)] * basis[i];
    }
    Eigen::Map<Vector>(mode_.data(), size) = root.cwiseProduct(x);
    return value;
}

} // namespace duet::solid
