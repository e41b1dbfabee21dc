// The same bits for any number of threads and after a restore.

#include "fluid_support.hpp"

#include <gtest/gtest.h>

namespace duet::fluid::test {
namespace {

Config stirred() {
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.04, false);
    config.walls = {{"left", {0, 0}, {0, 1}, 1.0, {}}, {"right", {1, 0}, {1, 1}, 0.0, {}}};
    config.kinematic_viscosity = 0.71;
    config.thermal_expansion = 1;
    config.gravity = {0, -7.1e4};
    config.disorder = 0.1;
    config.fourth_order = true; // all that is carried from step to step
    return config;
}

struct Body {
    std::vector<Chain> chains;
    InterfaceState start, end;
    Body() {
        square_body({0.4, 0.4}, 0.2, 10, chains, start);
        end = start;
        for (std::size_t i = 0; i < end.position.size(); ++i) { // a falling, warming body
            start.velocity[i] = end.velocity[i] = {0, -1};
            end.position[i] += Vec2{0, -2e-3};
            end.temperature[i] = 0.1;
        }
    }
};

TEST(FluidState, SameBitsForAnyNumberOfThreads) {
    Body body;
    std::string one;
    for (const int threads : {1, 2, 3}) {
        Config config = stirred();
        config.threads = threads;
        Fluid fluid(config, body.chains, body.start);
        fluid.advance(2e-3, body.start, body.end);
        fluid.advance(1e-3, body.end, body.end);
        EXPECT_GT(fluid.ledger().max_speed, 0.5);
        const std::string state = fluid.save();
        if (threads == 1) {
            one = state;
        }
        EXPECT_TRUE(state == one) << threads << " threads";
    }
}

TEST(FluidState, RestoreGoesOnWithTheSameBits) {
    Body body;
    Fluid whole(stirred(), body.chains, body.start);
    whole.advance(2e-3, body.start, body.end);
    whole.advance(0.01, body.end, body.end); // long enough for particles to change their cells
    const std::string saved = whole.save();
    std::vector<Values> before;
    for (int i = 1; i < 20; ++i) {
        before.push_back(whole.at({0.05 * i, 0.3}));
    }
    whole.advance(1e-3, body.end, body.end);

    Fluid resumed(stirred(), body.chains, body.start);
    resumed.restore(saved);
    EXPECT_EQ(resumed.time(), whole.time() - 1e-3);
    for (int i = 1; i < 20; ++i) {
        const Values after = resumed.at({0.05 * i, 0.3});
        EXPECT_EQ(after.temperature, before[static_cast<std::size_t>(i) - 1].temperature);
        EXPECT_EQ(after.pressure, before[static_cast<std::size_t>(i) - 1].pressure);
    }
    resumed.advance(1e-3, body.end, body.end);
    EXPECT_TRUE(resumed.save() == whole.save());
    EXPECT_EQ(resumed.passed().heat, whole.passed().heat);
    EXPECT_EQ(resumed.ledger().heat, whole.ledger().heat);
}

TEST(FluidState, ForeignBytesAreRefused) {
    Fluid fluid(stirred());
    EXPECT_THROW(fluid.restore("nonsense"), SceneError);
    const std::string saved = fluid.save();
    EXPECT_THROW(fluid.restore(saved.substr(0, saved.size() / 2)), SceneError);
    EXPECT_THROW(fluid.restore(saved + "x"), SceneError);
    Config other = stirred();
    other.spacing = 0.05;
    Fluid coarser(other);
    EXPECT_THROW(coarser.restore(saved), SceneError);
}

TEST(FluidState, ParticlesKeepTheirIdentity) {
    Fluid fluid(stirred());
    const Snapshot start = fluid.snapshot();
    Snapshot before = start;
    double farthest = 0;
    for (int window = 0; window < 30; ++window) {
        fluid.advance(5e-4);
        const Snapshot after = fluid.snapshot();
        for (std::size_t i = 0; i < before.position.size(); ++i) {
            EXPECT_LT(norm(after.position[i] - before.position[i]), 0.06) << "particle " << i;
            farthest = std::max(farthest, norm(after.position[i] - start.position[i]));
        }
        before = after;
    }
    EXPECT_GT(farthest, 0.2) << "too slow to change the order of the particles";
}

} // namespace
} // namespace duet::fluid::test
