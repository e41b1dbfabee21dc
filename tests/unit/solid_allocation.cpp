// A step takes no memory from the heap. A program of its own: it counts all that is allocated.

#include "tests/unit/solid_support.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

namespace {
std::size_t allocations = 0;
}

// Not inlined: GCC 12 would take std::free for a mismatch of the operator new that it stands for.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace duet::solid {
namespace {

TEST(SolidAllocation, AStepTakesNoMemory) {
    for (const Kinematics kinematics :
         {Kinematics::total_lagrangian, Kinematics::updated_lagrangian}) {
        BodyConfig config = test::steel_like(test::distorted_square(6));
        config.kinematics = kinematics;
        config.stiffness_damping = 0.01;
        config.boundary = {test::side(test::At::left), test::side(test::At::right)};
        config.boundary[0].convection = Convection{2, 290};
        config.boundary[1].traction = Point(0.1, 0);
        Body body(config);
        const double dt = 0.5 * body.stable_step();
        body.step(dt); // the first one may prepare
        const std::size_t before = allocations;
        EXPECT_GT(before, 0u); // it does count
        for (int i = 0; i < 10; ++i) {
            body.step(dt);
        }
        EXPECT_EQ(allocations, before);
    }
}

} // namespace
} // namespace duet::solid
