// Hooke's law with thermal stress, in the plane.

#pragma once

#include "solid_solver/body_config.hpp"

#include <array>

namespace duet::solid {

/// A symmetric tensor of the plane, e.g. a stress: xx, yy, xy, and zz out of the plane.
struct PlaneTensor {
    double xx = 0, yy = 0, xy = 0, zz = 0;
    double von_mises() const;
    /// Principal value in the plane: the larger for side = +1, the smaller for -1.
    double principal(double side) const;
};

/// S = lambda tr(E) I + 2 mu E - beta (T - T0) I with traces over the plane (6), (9). Plane strain:
/// lambda and beta are the material's. Plane stress: E_zz follows from S_zz = 0,
///
///     E_zz = swelling (T - T0) - thinning tr(E),
///     thinning = lambda/(lambda + 2 mu),  swelling = beta/(lambda + 2 mu),
///
/// which put into the law of space gives 2 mu lambda/(lambda + 2 mu) for lambda and
/// 2 mu beta/(lambda + 2 mu) for beta.
struct Law {
    double lambda, mu, beta;
    double thinning, swelling; ///< of plane stress; zero in plane strain
    double heat_capacity;      ///< J/(m3 K), see volumetric_capacity
    bool plane_stress;

    Law(const Material& m, const BodyConfig& body)
        : lambda(m.lambda()), mu(m.mu()), beta(m.beta()), thinning(0), swelling(0),
          heat_capacity(volumetric_capacity(m, body)), plane_stress(body.plane == Plane::stress) {
        if (plane_stress) {
            const double modulus = lambda + 2 * mu;
            thinning = lambda / modulus;
            swelling = beta / modulus;
            lambda *= 2 * mu / modulus;
            beta *= 2 * mu / modulus;
        }
    }

    /// S, or in the rate form dt times the stress rate, of a strain (xx, yy, xy) and a warming.
    PlaneTensor stress(double xx, double yy, double xy, double warming) const {
        const double mean = lambda * (xx + yy) - beta * warming;
        return {mean + 2 * mu * xx, mean + 2 * mu * yy, 2 * mu * xy, plane_stress ? 0 : mean};
    }
    /// The strain (xx, yy, xy) of a stress and a warming.
    std::array<double, 3> strain(double xx, double yy, double xy, double warming) const {
        const double thermal = beta * warming;
        const double trace = (xx + yy + 2 * thermal) / (2 * (lambda + mu));
        return {(xx + thermal - lambda * trace) / (2 * mu),
                (yy + thermal - lambda * trace) / (2 * mu),
                xy / (2 * mu)};
    }
    /// E_zz; zero in plane strain.
    double thickening(double trace, double warming) const {
        return swelling * warming - thinning * trace;
    }
    /// lambda/2 tr(E)^2 + mu E:E, J/m3.
    double energy(double xx, double yy, double xy) const {
        return 0.5 * lambda * (xx + yy) * (xx + yy) + mu * (xx * xx + yy * yy + 2 * xy * xy);
    }
};

} // namespace duet::solid
