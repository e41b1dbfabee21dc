// The kernel's integral by quadrature and its slope by difference quotients.

#include "fluid_solver/kernel.hpp"

#include <gtest/gtest.h>

namespace duet::fluid {
namespace {

TEST(FluidKernel, IntegratesToOne) {
    const Kernel kernel(0.37);
    const int rings = 20000;
    double integral = 0, second_moment = 0;
    for (int i = 0; i < rings; ++i) {
        const double width = kernel.support() / rings, r = (i + 0.5) * width;
        const double ring = 2 * std::numbers::pi * r * width;
        integral += ring * kernel.value(r);
        second_moment -= 0.5 * ring * kernel.slope_over_r(r) * r * r;
    }
    EXPECT_NEAR(integral, 1, 1e-8);      // midpoint rule: error of order 1/rings^2
    EXPECT_NEAR(second_moment, 1, 1e-8); // int -F x x dV = 1: what the Laplacian rests on
}

TEST(FluidKernel, SlopeIsTheDifferenceQuotient) {
    const Kernel kernel(1.3);
    for (double r = 0.05; r < 1.29; r += 0.07) {
        const double step = 1e-5;
        const double quotient = (kernel.value(r + step) - kernel.value(r - step)) / (2 * step);
        EXPECT_NEAR(kernel.slope_over_r(r) * r, quotient, 1e-8) << "at r = " << r;
    }
}

TEST(FluidKernel, VanishesSmoothlyAtTheSupport) {
    const Kernel kernel(2);
    EXPECT_EQ(kernel.value(2.0001), 0);
    EXPECT_NEAR(kernel.value(1.999), 0, 1e-11);
    EXPECT_NEAR(kernel.slope_over_r(1.999), 0, 1e-8);
}

} // namespace
} // namespace duet::fluid
