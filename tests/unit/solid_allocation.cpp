// A step takes no memory from the heap. A program of its own: it counts all that is allocated.

#include "tests/unit/solid_support.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#ifndef __SANITIZE_ADDRESS__ // which brings a malloc of its own
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
}
#endif

namespace {
std::size_t allocations = 0;
}

#ifndef __SANITIZE_ADDRESS__
// Below operator new, so that all are counted: Eigen's vectors come straight from malloc.
extern "C" {
void* malloc(std::size_t size) noexcept {
    ++allocations;
    return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
    ++allocations;
    return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
    ++allocations;
    return __libc_realloc(memory, size);
}
}
#endif

namespace duet::solid {
namespace {

TEST(SolidAllocation, AStepTakesNoMemory) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer's malloc cannot be counted";
#endif
    for (const Kinematics kinematics :
         {Kinematics::total_lagrangian, Kinematics::updated_lagrangian}) {
        BodyConfig config = test::steel_like(test::distorted_square(6));
        config.kinematics = kinematics;
        config.stiffness_damping = 0.01;
        config.boundary = {test::side(test::At::left), test::side(test::At::right)};
        config.boundary[0].convection =
            Convection{2, Field([](const Point&, double t) { return 290 + t; })};
        config.boundary[1].traction = Point(0.1, 0);
        config.boundary[1].pressure = Field([](const Point& p, double t) { return t * p.y(); });
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
