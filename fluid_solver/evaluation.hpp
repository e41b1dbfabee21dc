// The outer step's pass over all particles: neighbours, walls, operators, and with them the
// gradients, the diffusion terms and the shift; keeps the pair weights for the inner steps.

#pragma once

#include "fluid_solver/boundary.hpp"
#include "fluid_solver/chunks.hpp"
#include "fluid_solver/ghosts.hpp"
#include "fluid_solver/operators.hpp"
#include "fluid_solver/particles.hpp"

#include <cstdint>
#include <vector>

namespace duet::fluid {

/// One neighbour as the inner steps need it: w = V gradW, F stands for V F.
struct PairWeight {
    float x, y, F;
    std::uint32_t index;
};

/// What the walls add to the inner step of a particle near them.
struct WallTerms {
    Mat2 L_velocity;       ///< gradient correction of the velocity
    Mat2 L_N_n;            ///< times the body force: part of grad p / rho
    Vec2 L_N_acceleration; ///< its part that comes from the walls' acceleration
    Vec2 L_S;              ///< div v of the walls: value - v_a . L S
    double value = 0;      ///< sum v_wall . L S
};

/// A particle in the layer next to a wall from which flux and traction are taken.
struct WallSample {
    std::uint32_t particle;
    std::uint32_t cell;
    double distance;
    double along;        ///< of the foot point beyond the cell's middle, m
    Lanes wall;          ///< u, v, 0, T of the wall at the foot point
    double acceleration; ///< of the wall along its normal
};

/// Parameters of the pass.
struct EvaluationInput {
    double spacing, volume;
    double viscosity;    ///< m2/s
    double diffusivity;  ///< m2/s
    double shift_factor; ///< m2: dr = -shift_factor gradC
    bool heat;           ///< the temperature can change
};

class Evaluation {
  public:
    Evaluation(double spacing, int threads);

    /// Evaluates everything below for the sorted particles. Throws Diverged if a particle has more
    /// neighbours than a sane cloud can give it.
    void run(const Particles& particles,
             const CellGrid& grid,
             const Boundary& boundary,
             const EvaluationInput& input);

    // By particle:
    std::vector<Mat2> L;                  ///< gradient correction of the pressure
    std::vector<Fields> slope_x, slope_y; ///< gradients of u, v, p, T
    std::vector<Vec2> viscous;            ///< m/s2
    std::vector<double> heating;          ///< K/s
    std::vector<Vec2> shift;              ///< m
    std::vector<WallTerms> wall;          ///< only where near_wall
    std::vector<std::uint8_t> near_wall;
    std::vector<std::uint8_t> near_heated; ///< within the support of a heated wall
    std::vector<std::uint8_t> count;
    std::vector<std::vector<WallSample>> samples; ///< by chunk

    const PairWeight* pairs(std::size_t a) const { return &pairs_[a * stride_]; }
    const Kernel& kernel() const { return kernel_; }
    const Ghosts& ghosts() const { return ghosts_; }
    double sample_depth() const { return sample_depth_; }

  private:
    struct Scratch;
    struct Scene {
        const CellGrid& grid;
        const Boundary& boundary;
        const EvaluationInput& input;
    };
    void resize(std::size_t n);
    bool gather(std::size_t a, const Particles& particles, const Scene& scene, Scratch& s);
    void interior(std::size_t a, const Particles& particles, const Scene& scene, Scratch& s);
    template <bool Heat>
    void beside_walls(std::size_t a, const Particles& particles, const Scene& scene, Scratch& s);
    void store_diffusion(std::size_t a, const EvaluationInput& input, const Lanes& laplacian);
    void take_samples(std::size_t a,
                      const Boundary& boundary,
                      const std::vector<Contact>& contacts,
                      std::vector<WallSample>& out) const;
    /// Returns false if a particle has more neighbours than there is room for.
    template <bool Heat>
    bool run_chunk(std::size_t chunk,
                   std::size_t first,
                   std::size_t last,
                   const Particles& particles,
                   const Scene& scene);

    int threads_;
    Kernel kernel_;
    Ghosts ghosts_;
    double sample_depth_;
    std::size_t stride_ = 32;
    std::vector<PairWeight> pairs_;
};

} // namespace duet::fluid
