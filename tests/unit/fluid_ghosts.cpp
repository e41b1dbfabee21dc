// The ghost sums against an obvious twin: a fine lattice over the whole support, each point of it
// handed to the segment that the line from the particle crosses first.

#include "fluid_support.hpp"

#include <gtest/gtest.h>

namespace duet::fluid::test {
namespace {

constexpr double spacing = 0.1;

/// Where the way from x to x + r meets the segment, as a fraction; 2 if it does not.
double meets(Vec2 x, Vec2 r, const Segment& s) {
    const Vec2 t = s.b - s.a;
    const double parallel = cross(r, t);
    if (parallel == 0) {
        return 2;
    }
    const double fraction = cross(s.a - x, t) / parallel, along = cross(s.a - x, r) / parallel;
    return fraction > 0 && fraction <= 1 && along >= 0 && along <= 1 ? fraction : 2;
}

/// Before a long straight wall xi is the vector to the foot point, else to the crossing.
enum class Place { before_straight_walls, beside_an_edge };

WallSums twin(Vec2 x, const Boundary& boundary, Place place) {
    const Kernel kernel(support_in_spacings * spacing);
    WallSums sums{};
    const double R = kernel.support(), step = spacing / 80;
    for (double rx = -R + step / 2; rx < R; rx += step) {
        for (double ry = -R + step / 2; ry < R; ry += step) {
            const Vec2 r{rx, ry};
            if (norm(r) >= R) {
                continue;
            }
            double first = 2;
            Vec2 n;
            double d1 = 0;
            for (const Segment& s : boundary.segments()) {
                const double fraction = meets(x, r, s);
                if (fraction < first) {
                    first = fraction;
                    n = (1 / s.length) * left(s.b - s.a);
                    d1 = dot(s.a - x, n);
                }
            }
            if (first > 1) {
                continue;
            }
            const double VF = step * step * kernel.slope_over_r(norm(r));
            const double q = 1 + (dot(r, n) - d1) / std::max(d1, 0.25 * spacing);
            const Vec2 gradW = -VF * r;
            const Vec2 xi = place == Place::before_straight_walls ? d1 * n : first * r;
            sums.C += gradW;
            sums.u.S += q * gradW;
            sums.u.K += 2 * VF * q;
            sums.u.S_xi += outer(q * gradW, xi);
            sums.u.K_xi += (2 * VF * q) * xi;
            sums.N_n += outer(dot(r, n) * gradW, n);
        }
    }
    return sums;
}

void expect_near(const Mat2& a, const Mat2& b, double tolerance) {
    EXPECT_NEAR(a.xx, b.xx, tolerance);
    EXPECT_NEAR(a.xy, b.xy, tolerance);
    EXPECT_NEAR(a.yx, b.yx, tolerance);
    EXPECT_NEAR(a.yy, b.yy, tolerance);
}

/// Compares at several places. The ghosts' lattice is dx/3, so single sums scatter by a few percent
/// of the support's whole: 2 % of M's unit, of 1/dx, of 4/dx^2 (the sum of 2 V F over the plane).
void compare(const Boundary& boundary,
             Place place,
             const std::vector<Vec2>& places,
             double scale = 0.02) {
    const Ghosts ghosts(spacing);
    std::vector<Contact> contacts;
    for (const Vec2 x : places) {
        ASSERT_TRUE(boundary.contains(x));
        WallSums got{};
        boundary.contacts(x, contacts);
        ghosts.sums(boundary, contacts, got);
        const WallSums expected = twin(x, boundary, place);
        SCOPED_TRACE("particle at " + std::to_string(x.x) + ", " + std::to_string(x.y));
        EXPECT_NEAR(got.C.x, expected.C.x, scale / spacing);
        EXPECT_NEAR(got.C.y, expected.C.y, scale / spacing);
        EXPECT_NEAR(got.u.S.x, expected.u.S.x, 2 * scale / spacing);
        EXPECT_NEAR(got.u.S.y, expected.u.S.y, 2 * scale / spacing);
        EXPECT_NEAR(got.u.K, expected.u.K, 4 * scale / (spacing * spacing));
        EXPECT_NEAR(got.u.K_xi.x, expected.u.K_xi.x, 4 * scale / spacing);
        EXPECT_NEAR(got.u.K_xi.y, expected.u.K_xi.y, 4 * scale / spacing);
        expect_near(got.u.S_xi, expected.u.S_xi, scale);
        expect_near(got.N_n, expected.N_n, scale);
    }
}

TEST(FluidGhosts, StraightWall) {
    const Boundary boundary(closed({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, spacing, true), {}, {});
    compare(
        boundary, Place::before_straight_walls, {{1, 0.03}, {1, 0.05}, {1.013, 0.11}, {0.9, 0.2}});
}

TEST(FluidGhosts, StraightWallByDivergenceTheorem) {
    // int gradW over what lies behind the wall = n int W along the wall.
    const Ghosts ghosts(spacing);
    const Kernel kernel(support_in_spacings * spacing);
    for (const double d1 : {0.03, 0.08, 0.15}) {
        double integral = 0;
        const double step = 1e-4;
        for (double s = -kernel.support() + step / 2; s < kernel.support(); s += step) {
            integral += step * kernel.value(std::hypot(d1, s));
        }
        EXPECT_NEAR(ghosts.straight(d1).C, integral, 0.01 / spacing) << "d1 = " << d1;
    }
}

TEST(FluidGhosts, CornerOfTheCavity) {
    const Boundary boundary(closed({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, spacing, true), {}, {});
    compare(
        boundary, Place::beside_an_edge, {{0.05, 0.05}, {0.05, 0.15}, {0.21, 0.04}, {1.93, 0.08}});
}

TEST(FluidGhosts, AcuteAndObtuseCorners) {
    const Boundary boundary(closed({{0, 0}, {2, 0}, {0.8, 1.1}}, spacing, true), {}, {});
    compare(boundary, Place::beside_an_edge, {{0.15, 0.06}, {0.3, 0.1}, {1.6, 0.1}, {0.8, 0.95}});
}

TEST(FluidGhosts, CornerOfABody) {
    std::vector<Chain> chains;
    InterfaceState state;
    square_body({0.8, 0.8}, 0.5, 10, chains, state);
    const Boundary boundary(closed({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, spacing, true), chains, state);
    compare(boundary,
            Place::beside_an_edge,
            {{0.75, 0.75}, {0.75, 0.83}, {0.87, 0.74}, {1.35, 0.78}, {0.7, 1.31}});
}

TEST(FluidGhosts, ThinBodyIsNotSeenThrough) {
    const double thickness = 0.05;
    const Chain chain{{0, 1, 2, 3}, true};
    InterfaceState state{{{0.5, 1}, {1.5, 1}, {1.5, 1 + thickness}, {0.5, 1 + thickness}},
                         std::vector<Vec2>(4),
                         std::vector<double>(4)};
    const Config config = closed({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, spacing, true);
    const Boundary boundary(config, {chain}, state);
    compare(boundary, Place::before_straight_walls, {{1, 0.95}});
    compare(boundary, Place::beside_an_edge, {{1.46, 0.96}, {1.55, 1.02}, {0.47, 1.1}});
    const Particles particles = cloud(boundary, config, 0);
    Evaluation evaluation(spacing, 1);
    evaluation.run(
        particles, boundary.grid(), boundary, {spacing, spacing * spacing, 1, 1, 0, false});
    for (std::size_t a = 0; a < particles.size(); ++a) {
        for (const PairBlock& block : evaluation.pairs(a)) {
            for (const std::uint32_t b : block.index) {
                const Vec2 x = particles.position(a);
                for (const Segment& s : boundary.segments()) {
                    EXPECT_GT(meets(x, particles.position(b) - x, s), 1)
                        << "a pair looks through the body";
                }
            }
        }
    }
}

/// A blade bent along a circle of 12 spacings, with the segments half a spacing long: over a
/// support its wall departs from the tangent by 0.28 spacings at most.
struct Blade {
    static constexpr double radius = 1.2, thickness = 0.2, half_angle = 0.4;
    static constexpr std::uint32_t pieces = 20;
    Chain chain{{}, true};
    InterfaceState state;

    Blade() {
        // Below from left to right, then back above: counter-clockwise.
        for (const double r : {radius - thickness, radius}) {
            for (std::uint32_t i = 0; i <= pieces; ++i) {
                const double s = 2.0 * i / pieces - 1;
                const double angle = (r < radius ? -s : s) * half_angle;
                add(Vec2{1, -0.2} + r * Vec2{-std::sin(angle), std::cos(angle)});
            }
        }
    }
    void add(Vec2 x) {
        chain.nodes.push_back(static_cast<std::uint32_t>(state.position.size()));
        state.position.push_back(x);
        state.velocity.push_back({});
        state.temperature.push_back(x.x + 2 * x.y);
    }
};

TEST(FluidGhosts, ABentWallIsOneWall) {
    const Blade blade;
    const Config config = closed({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, spacing, true);
    const Boundary boundary(config, {blade.chain}, blade.state);
    std::vector<Contact> contacts;
    // Before the middle of a bent side, on the jutting and on the hollow one: one contact, its foot
    // on the wall, and the wall's values there.
    for (const double r : {Blade::radius + 0.07, Blade::radius - Blade::thickness - 0.07}) {
        for (const double angle : {-0.1, 0.0, 0.033}) {
            const Vec2 out{std::sin(angle), std::cos(angle)};
            const Vec2 x = Vec2{1, -0.2} + r * out;
            boundary.contacts(x, contacts);
            ASSERT_EQ(contacts.size(), 1u);
            const Contact& wall = contacts[0];
            EXPECT_NEAR(wall.distance, 0.07, 5e-4); // the sagitta of a segment
            EXPECT_NEAR(std::abs(dot(wall.normal, out)), 1, 5e-4);
            EXPECT_NEAR(dot(wall.normal, wall.tangent), 0, 1e-15);
            const Vec2 foot = x + wall.distance * wall.normal;
            EXPECT_NEAR(boundary.at(*wall.face, wall.foot).value[3], foot.x + 2 * foot.y, 1e-12);
            EXPECT_NEAR(
                wall.before() + wall.after(), 2 * Blade::half_angle * (r > 1.1 ? 1.2 : 1.0), 1e-3);
        }
    }
    // Values further along are those of the wall's nodes, whichever segment holds them.
    boundary.contacts({1, 1.07}, contacts);
    const Vec2 ahead = Vec2{1, -0.2} + 1.2 * Vec2{-std::sin(0.2), std::cos(0.2)};
    const double along = dot(contacts[0].tangent, Vec2{-1, 0}) * 0.24;
    EXPECT_NEAR(boundary.at(*contacts[0].face, contacts[0].foot + along).value[3],
                ahead.x + 2 * ahead.y,
                1e-3);
    // The sums are those of the tangent, which is what they stand for, and near those of the bend:
    // the sagitta of 0.28 spacings at the rim of the support, where the kernel has faded.
    compare(boundary, Place::before_straight_walls, {{1, 1.07}, {1.05, 1.12}, {1, 0.73}}, 0.04);
    // Beside the ends the sides and the end face are three walls.
    compare(boundary, Place::beside_an_edge, {{1.5, 0.95}, {1.45, 0.99}}, 0.04);
}

/// The kernel's integral over what the ghosts fill, and over where `behind` holds.
double filled(const Boundary& boundary, Vec2 x) {
    const Ghosts ghosts(spacing);
    const Kernel kernel(support_in_spacings * spacing);
    std::vector<Contact> contacts;
    boundary.contacts(x, contacts);
    double sum = 0;
    for (const Contact& contact : contacts) {
        ghosts.for_each(contact, contacts, kernel.support(), [&](Vec2 r, double, double V, double) {
            sum += V * kernel.value(norm(r));
        });
    }
    return sum;
}
template <class Behind>
double cut_off(Vec2 x, const Behind& behind) {
    const Kernel kernel(support_in_spacings * spacing);
    const double R = kernel.support(), step = spacing / 60;
    double sum = 0;
    for (double rx = -R + step / 2; rx < R; rx += step) {
        for (double ry = -R + step / 2; ry < R; ry += step) {
            sum += behind(x + Vec2{rx, ry}) ? step * step * kernel.value(std::hypot(rx, ry)) : 0;
        }
    }
    return sum;
}

/// However long the segments are, from a thirtieth of a spacing to ten of them, ghosts fill what
/// the body takes of the kernel (1 in all): a body with corners, and a round one.
TEST(FluidGhosts, ShortAndLongSegmentsFillWhatTheyCutOff) {
    const Config config = closed({{0, 0}, {4, 0}, {4, 4}, {0, 4}}, spacing, true);
    const auto in_square = [](Vec2 y) { return y.x > 1 && y.x < 2 && y.y > 1 && y.y < 2; };
    // A single ghost close by is worth 0.025; the mean over the places in a cell of their lattice
    // is free of where it lies. What is left (0.008 before the corner) is the lattice's quadrature.
    const auto mean = [](Vec2 x, const auto& integral) {
        double sum = 0;
        for (int k = 0; k < 25; ++k) {
            sum += integral(x + spacing / 15 * Vec2{k % 5 - 2.0, k / 5 - 2.0}) / 25;
        }
        return sum;
    };
    for (const Vec2 x : {Vec2{1.5, 0.93}, {0.95, 0.95}, {0.9, 1.04}, {1.97, 2.08}, {2.2, 2}}) {
        const double exact = mean(x, [&](Vec2 y) { return cut_off(y, in_square); });
        for (const std::uint32_t count : {1u, 10u, 300u}) {
            std::vector<Chain> chains;
            InterfaceState state;
            square_body({1, 1}, 1, count, chains, state);
            const Boundary boundary(config, chains, state);
            EXPECT_NEAR(mean(x, [&](Vec2 y) { return filled(boundary, y); }), exact, 0.01)
                << count << " segments a side, particle at " << x.x << ", " << x.y;
        }
    }
    for (const std::uint32_t count : {80u, 400u, 2500u}) { // 12, 2.5 and 0.4 % of a radius
        Chain chain{{}, true};
        InterfaceState state;
        for (std::uint32_t i = 0; i < count; ++i) {
            const double angle = 2 * std::acos(-1.0) * i / count;
            chain.nodes.push_back(i);
            state.position.push_back(Vec2{2, 2} + 1.2 * Vec2{std::cos(angle), std::sin(angle)});
            state.velocity.push_back({});
            state.temperature.push_back(0);
        }
        const Boundary boundary(config, {chain}, state);
        for (const double d1 : {0.03, 0.08, 0.15}) {
            const Vec2 x = Vec2{2, 2} + (1.2 + d1) * Vec2{0.6, 0.8};
            // The tangent stands for the bend: 0.28 spacings of sagitta at the rim of the support.
            EXPECT_NEAR(filled(boundary, x),
                        cut_off(x,
                                [](Vec2 y) {
                                    return norm(y - Vec2{2, 2}) < 1.2;
                                }),
                        0.03)
                << count << " segments, d1 = " << d1;
        }
    }
}

TEST(FluidGhosts, NarrowChannelSeesBothWalls) {
    const Boundary boundary(closed({{0, 0}, {2, 0}, {2, 0.3}, {0, 0.3}}, spacing, true), {}, {});
    compare(boundary, Place::before_straight_walls, {{1, 0.15}, {1, 0.05}});
    compare(boundary, Place::beside_an_edge, {{0.1, 0.15}});
}

} // namespace
} // namespace duet::fluid::test
