#include "solid_solver/equilibrium.hpp"

#include "solid_solver/stiffness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace duet::solid {

namespace {

class Search {
  public:
    Search(Mechanics& mechanics, std::span<const double> temperature, double tolerance)
        : mechanics_(mechanics), temperature_(temperature), tolerance_(tolerance),
          stiffness_(mechanics), none_(temperature.size(), 0.0),
          rest_(2 * temperature.size(), 0.0) {}

    /// The way from the imbalance of the start (share 0) to none (share 1), in steps that halve
    /// where Newton's method fails and double where it does not.
    Equilibrium run() {
        Eigen::VectorXd u = Eigen::Map<const Eigen::VectorXd>(
            mechanics_.displacement().data(), static_cast<Eigen::Index>(rest_.size()));
        start_ = imbalance(u);
        Eigen::VectorXd before = u;
        double done = 0, length = 1, length_before = 0;
        while (done < 1) {
            length = std::min(length, 1 - done);
            Eigen::VectorXd trial = u;
            if (length_before > 0) { // go on in the direction of the last step
                trial += length / length_before * (u - before);
            }
            if (newton(trial, 1 - done - length)) {
                before.swap(u);
                u.swap(trial);
                done += length;
                length_before = length;
                length *= 2;
            } else if (length < 1e-3) {
                fail(done);
            } else {
                length /= 2;
            }
        }
        mechanics_.set_motion({u.data(), rest_.size()}, rest_, temperature_);
        return result_;
    }

  private:
    /// f_ext - f_int where the body is free; sets scale_ to the size of the forces at work.
    Eigen::VectorXd imbalance(const Eigen::VectorXd& u) {
        mechanics_.evaluate({u.data(), rest_.size()}, rest_, temperature_, none_);
        Eigen::VectorXd sum(u.size());
        double squares = 0;
        for (std::size_t c = 0; c < rest_.size(); ++c) {
            const double load = mechanics_.load(c), inner = mechanics_.internal_force()[c];
            squares += load * load + inner * inner;
            sum[static_cast<Eigen::Index>(c)] =
                mechanics_.inverse_mass()[c] == 0 ? 0 : load + inner;
        }
        scale_ = std::sqrt(squares);
        return sum;
    }

    /// Solves imbalance(u) = share * start_. False if that takes more than 20 iterations.
    bool newton(Eigen::VectorXd& u, double share) {
        for (int i = 0; i <= 20; ++i) {
            const Eigen::VectorXd left = imbalance(u) - share * start_;
            const double scale = std::max(scale_, start_.norm());
            result_.residual = scale > 0 ? left.norm() / scale : 0;
            if (!std::isfinite(result_.residual)) {
                return false;
            }
            if (result_.residual <= tolerance_) {
                return true;
            }
            if (!stiffness_.factorise(mechanics_, {})) {
                return false; // nothing holds it, or it would not stay where it is
            }
            stiffness_.solve(left, correction_);
            u += correction_;
            ++result_.iterations;
        }
        return false;
    }

    [[noreturn]] void fail(double done) const {
        std::ostringstream sentence;
        sentence << "there is no static equilibrium on the way to the full loads beyond "
                 << 100 * done << " % of them (residual " << result_.residual << " after "
                 << result_.iterations
                 << " iterations); hold the body against rigid motion, or lower the loads.";
        throw std::runtime_error(sentence.str());
    }

    Mechanics& mechanics_;
    std::span<const double> temperature_;
    double tolerance_;
    Stiffness stiffness_;
    std::vector<double> none_, rest_;
    Eigen::VectorXd start_, correction_;
    double scale_ = 0;
    Equilibrium result_;
};

} // namespace

Equilibrium
find_equilibrium(Mechanics& mechanics, std::span<const double> temperature, double tolerance) {
    return Search(mechanics, temperature, tolerance).run();
}

Equilibrium relax(Mechanics& mechanics, std::span<const double> temperature, double tolerance) {
    constexpr int most = 100000;
    constexpr std::array share{0.9, 0.75, 0.6}; // of the stable step
    double largest = 0;                         // of the squared forces at work so far
    const auto residual = [&] {
        double left = 0, scale = 0;
        for (std::size_t c = 0; c < mechanics.inverse_mass().size(); ++c) {
            const double load = mechanics.load(c), inner = mechanics.internal_force()[c];
            scale += load * load + inner * inner;
            left += mechanics.inverse_mass()[c] == 0 ? 0 : (load + inner) * (load + inner);
        }
        largest = std::max(largest, scale);
        return largest > 0 ? std::sqrt(left / largest) : 0;
    };
    mechanics.settle();
    double energy = 0;
    std::size_t stops = 0;
    Equilibrium result;
    for (result.residual = residual(); result.residual > tolerance; result.residual = residual()) {
        if (++result.iterations > most || !std::isfinite(result.residual)) {
            std::ostringstream sentence;
            sentence << "there is no static equilibrium after " << most
                     << " steps of relaxation (residual " << result.residual
                     << "); hold the body against rigid motion, or lower the loads.";
            throw std::runtime_error(sentence.str());
        }
        mechanics.relax(share[stops % share.size()] * mechanics.stable_step(), temperature);
        const double now = mechanics.kinetic_energy();
        if (now < energy) {
            mechanics.settle();
            ++stops;
        }
        energy = now < energy ? 0 : now;
        if (result.iterations % 256 == 0) {
            mechanics.update_frequency();
        }
    }
    mechanics.settle();
    return result;
}

} // namespace duet::solid
