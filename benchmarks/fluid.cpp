// Each pass of the fluid's outer step on a disordered square of particles between walls: CPU
// nanoseconds for one particle (or one wall cell). The argument is the number of particles along a
// side.
//
//     build/release/bin/bench_fluid [--benchmark_filter=Search] [--benchmark_min_time=0.2]

#include "fluid_solver/fluid.hpp"
#include "benchmarks/heated_cavity.hpp"
#include "fluid_solver/closure.hpp"
#include "fluid_solver/pressure.hpp"
#include "fluid_solver/wall_estimate.hpp"
#include "tests/unit/fluid_support.hpp"

#include <benchmark/benchmark.h>

#include <memory>

namespace duet::fluid {
namespace {

/// One cavity of n x n particles, evaluated once.
struct Square {
    explicit Square(double n)
        : spacing(1 / n), config(test::closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, spacing, true)),
          boundary(config, {}, {}), particles(test::cloud(boundary, config, 0.15)),
          evaluation(spacing, 1),
          input{spacing, spacing * spacing, 1, 1, 0.01 * spacing * spacing, true} {
        test::set_fields(
            particles,
            [](Vec2 x) { return std::sin(3 * x.x) * std::cos(2 * x.y); },
            [](Vec2 x) { return std::cos(2 * x.x) * std::sin(3 * x.y); },
            [](Vec2 x) { return 1 - x.x + 0.1 * std::sin(5 * x.y); });
        hydrostatics.levels.assign(1, {{0.5, 0.5}, {0.5, 0.5}});
        evaluate();
    }
    void evaluate() { evaluation.run(particles, boundary.grid(), boundary, input); }

    double spacing;
    Config config;
    Boundary boundary;
    Particles particles;
    Evaluation evaluation;
    EvaluationInput input;
    Hydrostatics hydrostatics{1, 0.5, {0, 1}};
};

/// The square of the benchmark's argument; kept, because the largest takes a second to make.
Square& square(const benchmark::State& state) {
    static std::int64_t made = 0;
    static std::unique_ptr<Square> kept;
    if (made != state.range(0)) {
        kept = std::make_unique<Square>(static_cast<double>(state.range(0)));
        made = state.range(0);
    }
    return *kept;
}

/// Says CPU nanoseconds for each of `items`.
void report(benchmark::State& state, std::size_t items) {
    state.counters["ns_each"] = benchmark::Counter(static_cast<double>(items) * 1e-9,
                                                   benchmark::Counter::kIsIterationInvariantRate
                                                       | benchmark::Counter::kInvert);
}

void Sort(benchmark::State& state) {
    Square& s = square(state);
    for (auto _ : state) {
        s.particles.sort(s.boundary.grid());
    }
    report(state, s.particles.size());
}

/// Calls visit(a, surroundings) for all particles with the surroundings of its cell.
template <class Visit>
void for_cells(const Square& s, Surroundings& surroundings, const Visit& visit) {
    const CellGrid& grid = s.boundary.grid();
    int column = -1, row = -1;
    for (std::size_t a = 0; a < s.particles.size(); ++a) {
        const Vec2 x = s.particles.position(a);
        if (grid.column(x.x) != column || grid.row(x.y) != row) {
            column = grid.column(x.x);
            row = grid.row(x.y);
            surroundings.collect(s.particles, grid, column, row);
        }
        visit(a, x);
    }
}

void Search(benchmark::State& state) {
    const Square& s = square(state);
    const auto support = static_cast<float>(s.evaluation.kernel().support());
    Surroundings surroundings;
    Neighbours near;
    for (auto _ : state) {
        for_cells(s, surroundings, [&](std::size_t, Vec2 x) {
            benchmark::DoNotOptimize(surroundings.find(x, support, near));
        });
    }
    report(state, s.particles.size());
}

void WeightsAndMoments(benchmark::State& state) {
    const Square& s = square(state);
    const Kernel& kernel = s.evaluation.kernel();
    const auto support = static_cast<float>(kernel.support());
    Surroundings surroundings;
    Neighbours near;
    PairBlock pairs[most_neighbours / eight];
    DirectionWeights directions;
    // The neighbours of one particle again and again: what is measured is the arithmetic.
    for_cells(s, surroundings, [&](std::size_t a, Vec2 x) {
        if (a == s.particles.size() / 2) {
            surroundings.find(x, support, near);
        }
    });
    near.pad(2 * support, 0);
    for (auto _ : state) {
        Moments m = weigh(kernel, 1, near, pairs, directions);
        benchmark::DoNotOptimize(m);
        benchmark::ClobberMemory();
    }
    report(state, 1);
}

void Operators(benchmark::State& state) {
    Moments m;
    m.wxx = m.wyy = -1, m.qxxxx = -0.75F;
    OperatorBatch operators;
    for (auto _ : state) {
        operators.clear();
        for (std::size_t i = 0; i < OperatorBatch::room; ++i) {
            operators.add(m);
        }
        operators.solve();
        benchmark::ClobberMemory();
    }
    report(state, OperatorBatch::room);
}

/// Search, ghosts, weights, moments, operators, gradients and Laplacians of all particles.
void WholeEvaluation(benchmark::State& state) {
    Square& s = square(state);
    for (auto _ : state) {
        s.evaluate();
    }
    report(state, s.particles.size());
}

void ghosts_at(benchmark::State& state, Vec2 (*place)(double spacing)) {
    const Square& s = square(state);
    const Vec2 x = place(s.spacing);
    std::vector<Contact> contacts;
    s.boundary.contacts(x, contacts);
    WallSums sums;
    for (auto _ : state) {
        s.evaluation.ghosts().sums(s.boundary, contacts, sums);
        benchmark::ClobberMemory();
    }
    report(state, 1);
}
void GhostsBeforeAStraightWall(benchmark::State& state) {
    ghosts_at(state, [](double spacing) { return Vec2{0.5, 0.7 * spacing}; });
}
void GhostsInACorner(benchmark::State& state) {
    ghosts_at(state, [](double spacing) { return Vec2{0.7 * spacing, 1.2 * spacing}; });
}

/// `count` inner steps with what goes before and after them.
void inner_steps(benchmark::State& state, int count) {
    Square& s = square(state);
    Pressure pressure(1);
    InnerSteps inner;
    inner.count = count;
    inner.density = 1;
    inner.sound_speed = 10;
    inner.step = 1e-6 * s.spacing; // the fields stay what they are
    inner.hydrostatics = &s.hydrostatics;
    inner.smoothing_length = s.evaluation.kernel().smoothing_length();
    for (auto _ : state) {
        pressure.run<true>(s.particles, s.evaluation, inner);
    }
    report(state, s.particles.size());
}
void OneInnerStep(benchmark::State& state) {
    inner_steps(state, 1);
}
void ElevenInnerSteps(benchmark::State& state) {
    inner_steps(state, 11);
}

void WallEstimates(benchmark::State& state) {
    const Square& s = square(state);
    WallEstimate estimate(s.spacing);
    for (auto _ : state) {
        estimate.slopes(s.boundary, s.evaluation, s.particles, {1, 1, 1, 1});
        estimate.tractions(s.boundary, s.evaluation, s.particles, s.hydrostatics, {1, 1, 1, 1}, {});
    }
    report(state, s.boundary.cells().size());
}

void ClosedTemperature(benchmark::State& state) {
    Square& s = square(state);
    Closure closure(1, 1);
    for (auto _ : state) {
        closure.balance(s.particles, s.evaluation, 1e-9, {0});
        for (std::size_t a = 0; a < s.particles.size(); ++a) {
            closure.advance_temperature(s.particles, s.evaluation, 1e-9, a);
        }
    }
    report(state, s.particles.size());
}

/// Outer steps of a roll in a cavity, with two inner steps as long as it keeps its speed: what each
/// physics costs, by particle and step.
void outer_steps(benchmark::State& state, const Config& config) {
    Fluid fluid(config);
    const bool moves = config.kinematic_viscosity > 0;
    fluid.set_fields([&](Vec2 x) {
        Values values = roll(x);
        values.velocity = moves ? values.velocity : Vec2{};
        values.temperature = config.conductivity > 0 ? values.temperature : 0.5;
        return values;
    });
    std::size_t steps = 0;
    for (auto _ : state) {
        steps += static_cast<std::size_t>(fluid.advance(0.75 * fluid.stable_step()));
    }
    report(state, fluid.size() * steps / static_cast<std::size_t>(state.iterations()));
}
Config cavity_of(const benchmark::State& state) {
    Config config = heated_cavity(1e6, 1 / static_cast<double>(state.range(0)));
    config.disorder = 0.1;
    return config;
}
void StepOfHeatAlone(benchmark::State& state) {
    Config config = cavity_of(state);
    config.thermal_expansion = config.kinematic_viscosity = 0;
    outer_steps(state, config);
}
void StepOfFlowAlone(benchmark::State& state) {
    Config config = cavity_of(state);
    config.thermal_expansion = config.conductivity = 0;
    config.walls.clear();
    outer_steps(state, config);
}
void StepWithoutBuoyancy(benchmark::State& state) {
    Config config = cavity_of(state);
    config.thermal_expansion = 0;
    outer_steps(state, config);
}
void StepWithBuoyancy(benchmark::State& state) {
    outer_steps(state, cavity_of(state));
}

// What the machine gives, by one core.

/// a = b + c of 64 MB each: nanoseconds for 64 bytes, read and written.
void MachineStream(benchmark::State& state) {
    std::vector<float> a(1 << 24), b(1 << 24, 1.0F), c(1 << 24, 2.0F);
    for (auto _ : state) {
        for (std::size_t i = 0; i < a.size(); ++i) {
            a[i] = b[i] + c[i];
        }
        benchmark::ClobberMemory();
    }
    report(state, 3 * a.size() * sizeof(float) / 64);
}

/// Nanoseconds for one fused multiply and add of eight numbers, twelve chains at once.
void MachineArithmetic(benchmark::State& state) {
    Eight sums[12] = {};
    Eight factor = Eight{} + 0.5F;
    constexpr std::size_t rounds = 1000;
    for (auto _ : state) {
        benchmark::DoNotOptimize(factor);
        for (std::size_t i = 0; i < rounds; ++i) {
            for (Eight& sum : sums) {
                sum = sum * factor + factor;
            }
        }
        benchmark::DoNotOptimize(sums);
    }
    report(state, 12 * rounds);
}

/// Nanoseconds for reading four numbers side by side at an index read before, in the second-level
/// cache, and adding them up: the least that a neighbour costs a pass.
void MachineGather(benchmark::State& state) {
    std::vector<Slope> values(1 << 14);
    std::vector<std::uint32_t> index(1 << 14);
    std::mt19937 random(1);
    for (std::size_t i = 0; i < index.size(); ++i) {
        index[i] = static_cast<std::uint32_t>((i + random() % 256) % values.size());
    }
    for (auto _ : state) {
        Four sums[4] = {};
        for (std::size_t i = 0; i < index.size(); i += 4) {
            for (std::size_t k = 0; k < 4; ++k) {
                Four value;
                std::memcpy(&value, &values[index[i + k]], sizeof value);
                sums[k] += value;
            }
        }
        benchmark::DoNotOptimize(sums);
    }
    report(state, index.size());
}

BENCHMARK(MachineStream);
BENCHMARK(MachineArithmetic);
BENCHMARK(MachineGather);
BENCHMARK(Sort)->Arg(50)->Arg(100)->Arg(1000);
BENCHMARK(Search)->Arg(50)->Arg(100)->Arg(1000);
BENCHMARK(WeightsAndMoments)->Arg(100);
BENCHMARK(Operators);
BENCHMARK(WholeEvaluation)->Arg(50)->Arg(100)->Arg(1000);
BENCHMARK(GhostsBeforeAStraightWall)->Arg(100);
BENCHMARK(GhostsInACorner)->Arg(100);
BENCHMARK(OneInnerStep)->Arg(50)->Arg(100)->Arg(1000);
BENCHMARK(ElevenInnerSteps)->Arg(50)->Arg(100)->Arg(1000);
BENCHMARK(WallEstimates)->Arg(100);
BENCHMARK(ClosedTemperature)->Arg(100);
BENCHMARK(StepOfHeatAlone)->Arg(100)->Iterations(300);
BENCHMARK(StepOfFlowAlone)->Arg(100)->Iterations(300);
BENCHMARK(StepWithoutBuoyancy)->Arg(100)->Iterations(300);
BENCHMARK(StepWithBuoyancy)->Arg(100)->Iterations(300);

} // namespace
} // namespace duet::fluid

BENCHMARK_MAIN();
