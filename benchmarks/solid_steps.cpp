// The phases of a solid's step on 20 000 triangles, beside what the memory can move: smoothing
// domains a second, and bytes a second that the phase must read and write at least.

#include "solid_solver/body.hpp"
#include "solid_solver/shapes.hpp"

#include <benchmark/benchmark.h>

#include <optional>

namespace duet::solid {
namespace {

/// A square of 2 x 100 x 100 triangles, 30 200 smoothing domains.
BodyConfig square(double conductivity = 0.7) {
    BodyConfig config;
    config.name = "square";
    config.mesh = rectangle_mesh({0, 0}, 1, 1, 0.01);
    config.motion = Motion::deformable;
    config.material.density = 2;
    config.material.heat_capacity = 3;
    config.material.conductivity = conductivity;
    config.material.youngs_modulus = 5;
    config.material.thermal_expansion = 0.02;
    config.reference_temperature = 300;
    config.initial_temperature = 300;
    config.initial_velocity = Point(0.01, 0);
    return config;
}

void report(benchmark::State& state, const Body& body, double bytes_per_domain) {
    const double domains =
        static_cast<double>(state.iterations()) * static_cast<double>(body.domains().size());
    state.counters["domains/s"] = benchmark::Counter(domains, benchmark::Counter::kIsRate);
    if (bytes_per_domain > 0) {
        state.counters["bytes/s"] =
            benchmark::Counter(domains * bytes_per_domain, benchmark::Counter::kIsRate);
    }
}

/// a = b + 3 c over arrays of `range` numbers each: the bandwidth beside which to read the rest.
void triad(benchmark::State& state) {
    const auto count = static_cast<std::size_t>(state.range(0));
    std::vector<double> a(count, 0.0), b(count, 1.0), c(count, 2.0);
    for (auto _ : state) {
        for (std::size_t i = 0; i < count; ++i) {
            a[i] = b[i] + 3 * c[i];
        }
        benchmark::DoNotOptimize(a.data());
        benchmark::ClobberMemory();
    }
    state.counters["bytes/s"] = benchmark::Counter(static_cast<double>(state.iterations()) * 24.0
                                                       * static_cast<double>(count),
                                                   benchmark::Counter::kIsRate);
}
// About as much as a step touches (in the third-level cache), and far more.
BENCHMARK(triad)->Arg(400000)->Arg(16000000)->Unit(benchmark::kMillisecond);

// Of a domain: area 8, nodes 16, gradients 64, weights 32 bytes of constants, of the part's number
// 4, of the nodes 1/3 node each of displacement 16 and temperature 8.
constexpr double constants = 124;

void step(benchmark::State& state) {
    BodyConfig config = square();
    config.kinematics =
        state.range(0) == 0 ? Kinematics::total_lagrangian : Kinematics::updated_lagrangian;
    Body body(config);
    const double dt = 0.9 * body.stable_step();
    for (auto _ : state) {
        body.step(dt);
    }
    report(state, body, 0);
}
BENCHMARK(step)->ArgName("updated")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void forces(benchmark::State& state) {
    Body body(square());
    const double dt = 0.9 * body.stable_step();
    for (auto _ : state) {
        body.mechanics()->respond(dt, body.temperature());
    }
    // and the stress 24 written, the contributions 64 written and read.
    report(state, body, constants + 8 + 24 + 128);
}
BENCHMARK(forces)->Unit(benchmark::kMillisecond);

void heating(benchmark::State& state) {
    Body body(square());
    for (auto _ : state) {
        benchmark::DoNotOptimize(body.mechanics()->heating(1e-3).data());
    }
    report(state, body, constants + 16.0 / 3 + 64); // and the shares 32 written and read
}
BENCHMARK(heating)->Unit(benchmark::kMillisecond);

void drift(benchmark::State& state) {
    Body body(square());
    for (auto _ : state) {
        body.mechanics()->drift(1e-9);
    }
    report(state, body, 0);
}
BENCHMARK(drift)->Unit(benchmark::kMillisecond);

void conduction(benchmark::State& state) {
    Body body(square());
    const double dt = 0.5 * body.heat().stable_step();
    for (auto _ : state) {
        body.heat().step(dt);
    }
    report(state, body, 0);
}
BENCHMARK(conduction)->Unit(benchmark::kMillisecond);

void set_up(benchmark::State& state) {
    for (auto _ : state) {
        Body body(square());
        benchmark::DoNotOptimize(body.stable_step());
    }
}
BENCHMARK(set_up)->Unit(benchmark::kMillisecond);

/// An implicit step of `range` times the explicit limit; arguments: that, and whether heated.
void implicit_step(benchmark::State& state) {
    BodyConfig config = square();
    config.stepping = Stepping::implicit_steps;
    config.thermoelastic_heating = state.range(1) == 1;
    Body body(config);
    const double dt = static_cast<double>(state.range(0)) * body.stable_step();
    body.advance(dt); // the first one factorises
    const std::uint64_t before = body.implicit()->iterations();
    for (auto _ : state) {
        body.advance(dt);
    }
    state.counters["solves/step"] = static_cast<double>(body.implicit()->iterations() - before)
                                    / static_cast<double>(state.iterations());
}
BENCHMARK(implicit_step)
    ->ArgNames({"times", "heated"})
    ->Args({100, 0})
    ->Args({100, 1})
    ->Args({1000, 1})
    ->Unit(benchmark::kMillisecond);

void implicit_heat_step(benchmark::State& state) {
    BodyConfig config = square();
    config.motion = Motion::fixed;
    config.stepping = Stepping::implicit_steps;
    Body body(config);
    const double dt = 1000 * body.stable_step();
    body.advance(dt);
    for (auto _ : state) {
        body.advance(dt);
    }
}
BENCHMARK(implicit_heat_step)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace duet::solid

BENCHMARK_MAIN();
