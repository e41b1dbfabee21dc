// A state from a file of scattered points.

#include "fluid_solver/scattered_state.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <random>
#include <string>

namespace duet::fluid::test {
namespace {

/// A file with these lines, gone at the end.
struct File {
    explicit File(const std::string& text)
        : path(testing::TempDir() + "scattered_state-" + std::to_string(getpid()) + ".csv") {
        std::ofstream(path) << text;
    }
    ~File() { std::remove(path.c_str()); }
    std::string path;
};

std::string scattered(int count, double (*T)(double, double)) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0, 1);
    std::string text = "# a comment\nx, y, pressure, temperature, velocity_y\n";
    for (int i = 0; i < count; ++i) {
        const double x = place(random), y = place(random);
        text += std::to_string(x) + "," + std::to_string(y) + ",7," + std::to_string(T(x, y)) + ","
                + std::to_string(x - y) + "\n";
    }
    return text;
}

TEST(FluidScatteredState, LinearFieldsAreExactInsideAndBeyond) {
    const File file(scattered(200, [](double x, double y) { return 3 + 2 * x - y; }));
    const ScatteredState state(file.path);
    EXPECT_TRUE(state.has(ScatteredState::temperature));
    EXPECT_FALSE(state.has(ScatteredState::velocity_x));
    for (const Vec2 x : {Vec2{0.5, 0.5}, Vec2{0.03, 0.98}, Vec2{0.3, 0.71}, Vec2{1.02, 0.5}}) {
        // The file holds six decimals; beyond the points they count some five times.
        EXPECT_NEAR(state.at(ScatteredState::temperature, x), 3 + 2 * x.x - x.y, 1e-5);
        EXPECT_NEAR(state.at(ScatteredState::velocity_y, x), x.x - x.y, 1e-5);
    }
}

TEST(FluidScatteredState, PeriodicFieldsAreSmoothOverTheSides) {
    const auto T = [](double x, double y) {
        return std::sin(2 * M_PI * x + 1) + std::cos(2 * M_PI * y + 1);
    };
    const File file(scattered(2000, T));
    const ScatteredState state(file.path, {true, true}, {0, 0}, {1, 1});
    const ScatteredState along_x(file.path, {true, false}, {0, 0}, {1, 1});
    // Root mean squares along lines; the largest errors are those of single gaps between points.
    const auto error = [&](const ScatteredState& of, double y) {
        double squares = 0;
        for (double x = 0; x < 1; x += 0.01) {
            const double e = of.at(ScatteredState::temperature, {x, y}) - T(x, y);
            squares += e * e;
        }
        return std::sqrt(squares / 100);
    };
    const double inside =
        0.25 * (error(state, 0.21) + error(state, 0.43) + error(state, 0.64) + error(state, 0.87));
    EXPECT_LT(error(state, 0), 1.5 * inside);
    EXPECT_LT(error(state, 1), 1.5 * inside);
    EXPECT_GT(error(along_x, 1), 2 * inside) << "else a closed side would do as well";
}

TEST(FluidScatteredState, CurvedFieldsFollowThePoints) {
    const auto T = [](double x, double y) { return std::sin(3 * x) * std::cos(2 * y); };
    const auto error = [&](int count) {
        const File file(scattered(count, T));
        const ScatteredState state(file.path);
        double largest = 0;
        for (double x = 0.1; x < 0.95; x += 0.1) {
            largest = std::max(
                largest, std::abs(state.at(ScatteredState::temperature, {x, 0.5}) - T(x, 0.5)));
        }
        return largest;
    };
    // A plane misses T'' r^2/2, and r^2 falls as the number of points rises.
    const double coarse = error(400), fine = error(6400);
    EXPECT_LT(coarse, 0.03);
    EXPECT_LT(fine, coarse / 6);
}

TEST(FluidScatteredState, FarAwayTheNearestPointCounts) {
    // The weights of all points vanish there, in a square as on a line.
    for (const std::string points : {"0,0,1\n1,0,2\n0,1,3\n1,1,4\n", "0,0,1\n1,0,2\n2,0,2\n"}) {
        const File file("x,y,temperature\n" + points);
        const ScatteredState state(file.path);
        EXPECT_EQ(state.at(ScatteredState::temperature, {-100, -100}), 1);
        EXPECT_EQ(state.at(ScatteredState::temperature, {100, -100}), 2);
    }
}

TEST(FluidScatteredState, NoValueLeavesThoseOfThePointsAboutIt) {
    // A step: the plane through it overshoots on both sides, and runs away beyond the points.
    const File file(scattered(400, [](double x, double) { return x < 0.9 ? 0.0 : 1.0; }));
    const ScatteredState state(file.path);
    for (double x = -0.5; x < 1.5; x += 0.01) {
        const double T = state.at(ScatteredState::temperature, {x, 0.5});
        EXPECT_GE(T, 0) << x;
        EXPECT_LE(T, 1) << x;
    }
}

TEST(FluidScatteredState, SpreadsheetsAreRead) {
    const File file("\xEF\xBB\xBF\"x\",\"y\",\"a, b\",\"temperature\"\r\n0,0,7,1\r\n\r\n1,0,7,1\r\n"
                    "0,1,7,1,\r\n");
    const ScatteredState state(file.path);
    EXPECT_EQ(state.at(ScatteredState::temperature, {0.5, 0.5}), 1);
}

TEST(FluidScatteredState, FaultsAreSaidWithTheirPlace) {
    const auto fault = [](const std::string& text, const std::string& other = "") {
        const File file(text);
        try {
            ScatteredState{file.path + other};
        } catch (const std::invalid_argument& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(fault("x,y,density\n0,0,1\n").find("line 1: the columns x and y are needed"),
              std::string::npos);
    EXPECT_NE(fault("x,y,temperature\n0,0,1\n1,0,warm\n").find("line 3: 'warm'"),
              std::string::npos);
    EXPECT_NE(fault("x,y,temperature\n0,0\n").find("line 2: 3 numbers"), std::string::npos);
    EXPECT_NE(fault("x,y,temperature\n0,0,1\n").find("at least three points"), std::string::npos);
    EXPECT_NE(fault("", ".csv").find(".csv.csv: the file cannot be opened"), std::string::npos);
    EXPECT_NE(fault("").find(".csv: the file is empty"), std::string::npos);
    EXPECT_NE(fault("# no more\n").find(".csv: the file is empty"), std::string::npos);
    EXPECT_NE(fault("x,y,temperature\n0,0,1\n0,0,1\n0,0,1\n").find(".csv: the points lie all at"),
              std::string::npos);
    EXPECT_EQ(fault("x,y,temperature\n0,0,1\n1,0,2\n0,1,3\n"), "");
}

} // namespace
} // namespace duet::fluid::test
