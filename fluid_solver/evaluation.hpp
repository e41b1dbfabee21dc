// The outer step's pass over all particles: neighbours, walls, operators, and with them the
// gradients, the diffusion terms and the shift; keeps the pair weights for the inner steps.

#pragma once

#include "fluid_solver/boundary.hpp"
#include "fluid_solver/chunks.hpp"
#include "fluid_solver/ghosts.hpp"
#include "fluid_solver/operators.hpp"
#include "fluid_solver/particles.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace duet::fluid {

/// A 2 x 2 matrix, and a vector, as the inner steps read them.
struct alignas(16) Correction {
    float xx, xy, yx, yy;
};
struct WeightSum {
    float x, y;
};

/// What of the friction on u and on v of a particle follows them within the outer step, 1/s.
struct Friction {
    double u = 0, v = 0;
};

/// What the walls add to the inner step of a particle near them.
struct WallTerms {
    Correction L_velocity; ///< gradient correction of the velocity
    Mat2 L_N_n;            ///< times the body force: part of grad p / rho
    Vec2 L_N_acceleration; ///< its part that comes from the walls' acceleration
    Vec2 L_S;              ///< div v of the walls: value - v_a . L S
    double value = 0;      ///< sum v_wall . L S
    float softness = 1;    ///< the share of c^2 that the particle's own stiffness allows
    Friction friction;
    double distance = 0; ///< m, of the nearest point of any wall
};

/// A particle in the layer next to a wall from which flux and traction are taken.
struct WallSample {
    std::uint32_t particle;
    std::uint32_t cell;
    double distance;
    double along;        ///< of the foot point beyond the cell's middle, m
    Lanes wall;          ///< u, v, 0, T of the wall at the foot point
    Lanes fields;        ///< of the particle when it was evaluated: what diffusion was given
    double acceleration; ///< of the wall along its normal
    // Errors of the operators on profiles that are typical beside a wall; 0 but at the nearest.
    double bend_error = 0;    ///< m: of div v, for each 1/(m s) of u_n,nn
    double quartic_error = 0; ///< m2: of lap T, for each K/m4 of q in T_w - g d + q d^4
};

/// Parameters of the pass.
struct EvaluationInput {
    double spacing, volume;
    double viscosity;          ///< m2/s
    double diffusivity;        ///< m2/s
    double shift_factor;       ///< m2: dr = -shift_factor gradC
    bool heat;                 ///< the temperature can change
    double step = 0;           ///< s, the outer one; with 0 no friction follows
    bool fourth_order = false; ///< needs the particles' rates and Laplacians of late
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
    std::vector<Correction> L;                    ///< gradient correction of the pressure
    std::vector<Slope> slope_x, slope_y;          ///< gradients of u, v, p, T
    std::vector<Vec2> viscous;                    ///< m/s2
    std::vector<double> heating;                  ///< K/s
    std::vector<Vec2> shift;                      ///< m
    std::vector<Slope> laplacian;                 ///< of u, v, T, uncorrected; with fourth_order
    std::vector<WeightSum> weight_sum;            ///< sum w
    std::vector<std::uint8_t> near_heated;        ///< within the support of a heated wall
    std::vector<std::uint8_t> count;              ///< of neighbours
    std::vector<std::vector<WallSample>> samples; ///< by chunk

    /// The neighbours of a, in eights.
    std::span<const PairBlock> pairs(std::size_t a) const {
        return {&pairs_[a / chunk_size * chunk_blocks_ + first_block_[a]],
                (count[a] + eight - 1) / eight};
    }
    /// The terms of a particle near a wall; null away from walls.
    const WallTerms* wall(std::size_t a) const {
        const std::uint8_t slot = wall_slot_[a];
        return slot == no_wall ? nullptr : &wall_[a / chunk_size][slot];
    }
    /// A further body force b on a particle: frozen acceleration, and beside walls the part
    /// rho b.n of the pressure's known slope.
    void add_force(std::size_t a, Vec2 b) {
        viscous[a] += b;
        if (const std::uint8_t slot = wall_slot_[a]; slot != no_wall) {
            WallTerms& terms = wall_[a / chunk_size][slot];
            terms.L_N_acceleration -= terms.L_N_n * b;
        }
    }
    /// The weight of a sample at the distance d of the wall.
    double sample_weight(double d) const { return 1 - d / sample_depth_; }
    /// Takes the errors of the samples out of div v, the share `smooth` of them, and out of dT/dt:
    /// `bends` are u_n,nn, 1/(m s), and `quartics` q, K/m4, by wall cell.
    void correct_samples(std::span<const double> bends,
                         std::span<const double> quartics,
                         double diffusivity,
                         double smooth);
    const Kernel& kernel() const { return kernel_; }
    const Ghosts& ghosts() const { return ghosts_; }

  private:
    struct Work;
    struct Scratch;
    struct Scene {
        const CellGrid& grid;
        const Boundary& boundary;
        const EvaluationInput& input;
        const std::vector<Fields>& fields; ///< of the particles
    };
    void resize(std::size_t n);
    void predict(const Particles& particles, double ahead);
    template <bool Heat>
    bool
    gather(std::size_t a, const Particles& particles, const Scene& scene, Scratch& s, Work& work);
    void interior(std::size_t a,
                  const std::vector<Slope>& deferred,
                  const Scene& scene,
                  const Scratch& s,
                  const Work& work);
    void beside_walls(std::size_t a, const Scene& scene, const Scratch& s, const Work& work);
    void store_diffusion(std::size_t a, const EvaluationInput& input, const Four& laplacian);
    void take_samples(std::size_t a,
                      const Scene& scene,
                      const Scratch& s,
                      const Work& work,
                      std::vector<WallSample>& out) const;
    double quartic_error(const Scratch& s, const Work& work) const;
    /// Returns false if particles have more neighbours than there is room for.
    template <bool Heat>
    bool run_chunk(std::size_t chunk,
                   std::size_t first,
                   std::size_t last,
                   const Particles& particles,
                   const Scene& scene);

    static constexpr std::uint8_t no_wall = 255;
    static_assert(chunk_size < no_wall);

    int threads_;
    Kernel kernel_;
    float lattice_error_; ///< m2, of the Laplacian
    Ghosts ghosts_;
    double sample_depth_;
    std::size_t chunk_blocks_; ///< room for the pairs of a chunk
    std::vector<PairBlock> pairs_;
    std::vector<Fields> predicted_;          ///< in the middle of the step
    std::vector<std::uint16_t> first_block_; ///< of a particle in its chunk
    std::vector<std::uint8_t> wall_slot_;    ///< in its chunk
    std::vector<std::vector<WallTerms>> wall_;
};

} // namespace duet::fluid
