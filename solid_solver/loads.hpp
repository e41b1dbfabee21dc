// What the conditions of a deformable body do to its nodes: forces, and prescribed motion.

#pragma once

#include "solid_solver/body_config.hpp"

#include <array>
#include <span>
#include <vector>

namespace duet::solid {

class Loads {
  public:
    Loads() = default;
    /// `mass` [N] kg/m. Throws std::invalid_argument naming the body if a condition finds no edge,
    /// or prescribes both displacement and velocity.
    Loads(const BodyConfig& body, std::span<const double> mass);

    /// Forces on the nodes at a time, N/m: body force, traction, point loads and pressure on the
    /// boundary where it is at `position` [N][2] m. Replaces `out` [N][2].
    void forces(double time, std::span<const double> position, std::span<double> out) const;
    /// The forces change in time or with the motion.
    bool vary() const { return varies_; }

    /// A component of a node that does not move freely.
    struct Held {
        std::uint32_t component; ///< 2 * node + direction
        Point place;             ///< m, reference
        Field value;             ///< m, or m/s for a velocity
        bool velocity;
        std::size_t condition; ///< index of the boundary condition; the last one that holds it
    };
    std::span<const Held> held() const { return held_; }
    /// Some held component moves.
    bool moves() const { return moves_; }

  private:
    /// A field on one boundary edge. The nodes share it by the shape functions, it being linear
    /// along the edge.
    struct OnEdge {
        std::uint32_t a, b;
        VectorField traction;
        Field pressure;
    };
    struct OnNode {
        std::uint32_t node;
        VectorField force;
    };

    void hold(std::uint32_t node,
              int direction,
              const Field& value,
              bool velocity,
              std::size_t condition);

    std::vector<Point> place_;       ///< [N] m, reference
    std::vector<double> body_force_; ///< [N][2] N/m
    std::vector<OnEdge> edge_;
    std::vector<OnNode> point_;
    std::vector<Held> held_; ///< by component
    bool varies_ = false, moves_ = false;
};

} // namespace duet::solid
