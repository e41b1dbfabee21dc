// Meshes and bodies that the tests of the solid share.

#pragma once

#include "solid_solver/body.hpp"
#include "solid_solver/shapes.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

namespace duet::solid::test {

/// Numbers between -1 and 1, the same on every machine.
class Noise {
  public:
    double operator()() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state_ >> 11) / 4503599627370496.0 - 1;
    }

  private:
    std::uint64_t state_ = 12345;
};

/// The unit square in cells of 1/cells, its inner nodes moved by up to 0.3 cells either way.
inline Mesh distorted_square(unsigned cells) {
    const double h = 1.0 / cells;
    Mesh mesh = rectangle_mesh({0, 0}, 1, 1, h);
    Noise noise;
    for (Point& p : mesh.node) {
        if (p.x() > 0.5 * h && p.x() < 1 - 0.5 * h && p.y() > 0.5 * h && p.y() < 1 - 0.5 * h) {
            p += 0.3 * h * Point(noise(), noise());
        }
    }
    return mesh;
}

inline bool on_unit_square(const Point& p) {
    return p.x() == 0 || p.x() == 1 || p.y() == 0 || p.y() == 1;
}

inline BodyConfig steel_like(Mesh mesh) {
    BodyConfig config;
    config.name = "block";
    config.mesh = std::move(mesh);
    config.motion = Motion::deformable;
    config.material.density = 2;
    config.material.heat_capacity = 3;
    config.material.conductivity = 0.7;
    config.material.youngs_modulus = 5;
    config.material.poissons_ratio = 0.3;
    config.material.thermal_expansion = 0.02;
    config.reference_temperature = 300;
    config.initial_temperature = 300;
    return config;
}

/// A condition on one side of the rectangle (0, 0) .. (width, height).
enum class At { left, right, bottom, top };
inline BoundaryCondition side(At at, double width = 1, double height = 1) {
    BoundaryCondition condition;
    condition.name = "side";
    condition.from = at == At::right ? Point(width, 0)
                     : at == At::top ? Point(0, height)
                                     : Point(0, 0);
    condition.to = at == At::left     ? Point(0, height)
                   : at == At::bottom ? Point(width, 0)
                                      : Point(width, height);
    return condition;
}

/// Nodal values [N][2] of a vector field of the reference place.
template <class Value>
std::vector<double> nodal_vector(const Mesh& mesh, const Value& value) {
    std::vector<double> result;
    for (const Point& p : mesh.node) {
        const Point v = value(p);
        result.push_back(v.x());
        result.push_back(v.y());
    }
    return result;
}

} // namespace duet::solid::test
