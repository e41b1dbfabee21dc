// The state of the fluid and the pieces that advance it; private to the core.

#pragma once

#include "fluid_solver/boundary.hpp"
#include "fluid_solver/closure.hpp"
#include "fluid_solver/evaluation.hpp"
#include "fluid_solver/fluid.hpp"
#include "fluid_solver/hydrostatics.hpp"
#include "fluid_solver/paper_formulation.hpp"
#include "fluid_solver/particles.hpp"
#include "fluid_solver/pressure.hpp"
#include "fluid_solver/wall_estimate.hpp"

#include <array>
#include <ctime>
#include <optional>
#include <vector>

namespace duet::fluid {

enum PhaseIndex { moving, sorting, evaluating, inner_steps, walls_and_closure };

/// Adds the CPU time of its own life, all threads together, to a phase.
class Stamp {
  public:
    explicit Stamp(double& seconds) : seconds_(seconds) {}
    ~Stamp() { seconds_ += static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }
    Stamp(const Stamp&) = delete;
    Stamp& operator=(const Stamp&) = delete;

  private:
    double& seconds_;
    std::clock_t start_ = std::clock();
};

class Fluid::Implementation {
  public:
    Implementation(const Config& config,
                   const std::vector<Chain>& chains,
                   const InterfaceState& interface);

    void set_fields(const std::function<Values(Vec2)>& field);
    int advance(double window, const InterfaceState& start, const InterfaceState& end);
    double stable_step() const;
    double smoothness() const;
    double diffusivity() const { // of heat, m2/s
        return config.conductivity / (config.density * config.heat_capacity);
    }
    Ledger ledger() const;
    void mark();
    std::vector<std::string> model() const;
    Values at(Vec2 point) const;
    Snapshot snapshot() const;
    std::vector<Phase> phases() const;
    std::string save() const;
    void restore(const std::string& state);

    Config config;
    double time = 0;
    double volume = 0; ///< of a particle, m2
    std::size_t compartments = 1;
    Particles particles;
    InterfaceImpulse passed;
    std::vector<WallReport> walls;

  private:
    /// The interface at the ends of the present window.
    struct Motion {
        const InterfaceState* start = nullptr;
        const InterfaceState* end = nullptr;
        double window = 0;
    };

    // placement.cpp
    void fill();
    void disturb();
    void relax();
    void find_compartments();
    void put_inside();
    static constexpr double clearance = 0.1; ///< of a spacing: how far before a wall it puts

    // paper_step.cpp
    void paper_step(double dt, double elapsed, const Motion& motion);

    // fluid.cpp
    void step(double dt, double elapsed, const Motion& motion);
    void conduct(double dt, double elapsed, const Motion& motion);
    bool at_rest(const Motion& motion) const;
    void follow_interface(const Motion& motion);
    void place_interface(double elapsed, const Motion& motion);
    void put_interface();
    Vec2 way(std::size_t a, double dt, bool with_shift) const {
        const Vec2 flow{particles.fields[a].u, particles.fields[a].v};
        return dt * flow + (with_shift ? evaluation_.shift[a] : Vec2{});
    }
    void move(double dt, bool with_shift);
    void wrap();
    void put(std::size_t a, Vec2 place);
    void evaluate(double dt);
    void begin_step(double dt, double elapsed, const Motion& motion);
    void finish_step(double dt, double elapsed, const Motion& motion);
    void take_body_force(double now);
    void accelerate(double dt);
    void balance_heat(double dt);
    void correct_fields(double dt);
    void start();

    // crossing.cpp
    /// The half of a step that has just been made.
    struct HalfStep {
        double end;    ///< s
        double length; ///< s
        bool with_shift;
    };
    /// A particle that would have crossed a wall and is held off, and its speed into the wall.
    struct Touch {
        std::size_t particle;
        Boundary::Crossing at;
        double into; ///< m/s
    };
    /// Of the particles of a chunk.
    struct Held {
        std::vector<Touch> touches;
        std::optional<Touch> escaped; ///< the first one that could not be held off
    };
    void hold_off_walls(const HalfStep& half);
    void hold_off(std::size_t a, const HalfStep& half, double wall_way, Held& held);
    void slow_approach(std::size_t a, const HalfStep& half, const Boundary::Nearest& wall);
    bool put_before(std::size_t a, const Boundary::Crossing& crossing);
    void book_touch(const Touch& touch);
    [[noreturn]] void report_escape(const Touch& escaped, double now) const;

    // contact.cpp
    double& least_gap(const Boundary::Gap& gap);
    void measure_gaps();
    void check_gaps(double now);

    // booking.cpp
    Vec2 momentum() const;
    void close_momentum();
    WallMaterial wall_material() const;
    void estimate_slopes();
    void book(double dt);
    Vec2 wall_velocity(std::size_t cell) const;
    void pass(std::uint32_t cell, double heat, Vec2 impulse);

    // sound.cpp
    void level();
    void measure();
    double fastest() const;
    void adapt_sound_speed();

    // diagnostics.cpp
    double kinetic_energy() const;

    /// Sum of term(a) over the particles, in fixed chunks.
    template <class Term>
    auto sum(const Term& term) const {
        using Number = decltype(term(std::size_t{}));
        static thread_local std::vector<Number> parts; // keeps its room from call to call
        parts.resize(chunks_of(particles.size()));
        std::vector<Number>& shared = parts; // this thread's, for all
        for_chunks(particles.size(),
                   config.threads,
                   [&](std::size_t c, std::size_t first, std::size_t last) {
                       Number part{};
                       for (std::size_t a = first; a < last; ++a) {
                           part += term(a);
                       }
                       shared[c] = part;
                   });
        Number total{};
        for (const Number& part : parts) {
            total += part;
        }
        return total;
    }

    // state.cpp
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self);

    Boundary boundary_;
    CellGrid grid_;
    Evaluation evaluation_;
    Pressure pressure_;
    std::optional<paper::Rates> paper_; ///< in the paper's formulation alone
    WallEstimate wall_estimate_;
    Closure closure_;
    Hydrostatics hydrostatics_;
    bool heat_ = false, buoyant_ = false;
    bool forced_ = false;       ///< by a body force of the configuration
    bool walls_change_ = false; ///< their values, in time
    bool walls_move_ = false;
    bool still_ = false;                ///< nothing moves, nor will in this window: heat alone
    Vec2 initial_momentum_;             ///< N s/m at t = 0
    double initial_heat_ = 0;           ///< J/m at t = 0
    double initial_kinetic_energy_ = 0; ///< J/m
    double speed_ = 0;                  ///< largest, m/s
    double pressure_range_ = 0;
    double body_force_ = 0; ///< mean departure from its level, m/s2
    double sound_speed_ = 0;
    /// Time and what had passed from the interface at the last mark.
    struct Mark {
        double time = 0, heat = 0;
        Vec2 impulse;
    };
    Mark mark_;
    Ledger totals_;                ///< what accumulates: exchanges, closure, wall hits
    std::vector<Held> held_;       ///< by chunk
    bool evaluated_ = false;       ///< the evaluation is of the particles in their present order
    std::vector<double> farthest_; ///< m, by chunk: the longest way of the last half step
    double nearer_before_ = 0;     ///< m: what the half step before can have brought together
    /// Of the particles of a chunk.
    struct Extremes {
        double speed2 = 0, lowest = 1e300, highest = -1e300;
        double body_force = 0; ///< sum of what the hydrostatic pressure leaves of it, m/s2
        long lost = 0;         ///< not finite
    };
    std::vector<Extremes> extremes_;
    std::vector<Lanes> means_;             ///< by chunk and compartment: p, T, x, y
    std::vector<double> compartment_size_; ///< particles of each
    std::vector<double> passed_heat_;      ///< by compartment, in one step
    std::vector<Vec2> given_force_;        ///< m/s2, by particle; only where there is one
    std::vector<double> wall_heat_, interface_heat_;
    std::vector<Vec2> interface_position_, interface_velocity_, interface_acceleration_;
    std::vector<Vec2> interface_before_; ///< m, half a step ago
    std::vector<Boundary::Gap> gaps_;
    std::vector<double> least_gaps_; ///< m, by two parts of the boundary
    std::vector<double> interface_temperature_;
    std::array<double, 8> phase_seconds_{};
};

} // namespace duet::fluid
