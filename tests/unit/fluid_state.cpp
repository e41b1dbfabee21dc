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
    const std::string saved = whole.save();
    const Values before = whole.at({0.2, 0.3});
    whole.advance(1e-3, body.end, body.end);

    Fluid resumed(stirred(), body.chains, body.start);
    resumed.restore(saved);
    EXPECT_EQ(resumed.time(), 2e-3);
    EXPECT_EQ(resumed.at({0.2, 0.3}).temperature, before.temperature);
    EXPECT_EQ(resumed.at({0.2, 0.3}).pressure, before.pressure);
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
    Body body;
    Fluid fluid(stirred(), body.chains, body.start);
    const Snapshot before = fluid.snapshot();
    fluid.advance(1e-4, body.start, body.start);
    const Snapshot after = fluid.snapshot();
    for (std::size_t i = 0; i < before.position.size(); ++i) {
        EXPECT_LT(norm(after.position[i] - before.position[i]), 0.04) << "particle " << i;
    }
}

} // namespace
} // namespace duet::fluid::test
