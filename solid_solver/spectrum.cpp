#include "solid_solver/spectrum.hpp"

namespace duet::solid {

double Spectrum::largest(const Operator& stiffness,
                         std::span<const double> inverse,
                         int most,
                         double tolerance) {
    double quotient = 0, before = 0;
    for (int round = 1; round <= most; ++round) {
        double norm = 0; // x . M x
        for (std::size_t i = 0; i < mode_.size(); ++i) {
            if (inverse[i] == 0) {
                mode_[i] = 0;
            } else {
                norm += mode_[i] * mode_[i] / inverse[i];
            }
        }
        if (norm == 0) {
            return 0; // everything is held
        }
        const double scale = 1 / std::sqrt(norm);
        for (double& value : mode_) {
            value *= scale;
        }
        stiffness(mode_.data(), image_.data());
        quotient = 0; // x . K x
        for (std::size_t i = 0; i < mode_.size(); ++i) {
            quotient += mode_[i] * image_[i];
            image_[i] *= inverse[i];
        }
        if (quotient <= 0) {
            return 0;
        }
        mode_.swap(image_);
        if (round % 10 == 0) {
            if (quotient - before < tolerance * quotient) {
                break;
            }
            before = quotient;
        }
    }
    return quotient;
}

} // namespace duet::solid
