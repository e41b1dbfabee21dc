// Marks are met exactly, windows never exceed the stable step, and leases follow one another.

#include "orchestrator/calendar.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace duet::orchestrator {
namespace {

v1::Scene scene(double end, double probes, double snapshots, const std::vector<double>& checks) {
    v1::Scene s;
    s.mutable_time()->set_end(end);
    s.mutable_output()->set_probe_interval(probes);
    s.mutable_output()->set_interval(snapshots);
    s.add_probe();
    for (const double t : checks)
        s.add_check()->add_at(t);
    return s;
}

TEST(Calendar, MarksAreMergedAndEndTheRun) {
    const std::vector<Mark> marks = marks_of(scene(1, 0.25, 0.5, {0.5, 0.7, 1}));
    ASSERT_EQ(marks.size(), 5u);
    const std::vector<double> times = {0.25, 0.5, 0.7, 0.75, 1};
    for (std::size_t i = 0; i < times.size(); ++i) {
        EXPECT_EQ(marks[i].time, times[i]);
        EXPECT_TRUE(marks[i].sample);
        EXPECT_EQ(marks[i].snapshot, i == 1 || i == 4);
    }
}

TEST(Calendar, WithoutIntervalsAHundredProbesAndOneSnapshot) {
    const std::vector<Mark> marks = marks_of(scene(3, 0, 0, {}));
    EXPECT_EQ(marks.size(), 100u);
    EXPECT_EQ(std::count_if(marks.begin(), marks.end(), [](const Mark& m) { return m.snapshot; }),
              1);
}

TEST(Calendar, LeasesTileTheRunAndMeetEveryMark) {
    const v1::Scene s = scene(1, 0.3, 0, {0.37});
    const std::vector<Mark> marks = marks_of(s);
    for (const double stable : {0.0, 1.0, 0.1, 0.011, 0.0001}) {
        Calendar calendar(s);
        std::uint64_t window = 0;
        double time = 0;
        std::size_t met = 0;
        while (!calendar.done()) {
            const v1::Lease lease = calendar.next(stable, 16);
            ASSERT_EQ(lease.first(), window);
            ASSERT_NEAR(lease.time(), time, 1e-14);
            ASSERT_GE(lease.count(), 1u);
            ASSERT_LE(lease.count(), 16u);
            ASSERT_LE(lease.length(),
                      (stable > 0 ? stable : 0.01) * (1 + 1e-8)); // without limit: end/100
            window += lease.count();
            time = lease.time() + lease.count() * lease.length();
            if (lease.sample()) {
                ASSERT_LT(met, marks.size());
                ASSERT_NEAR(time, marks[met].time, 1e-14);
                ++met;
            }
        }
        EXPECT_EQ(met, marks.size()) << "stable step " << stable;
        EXPECT_NEAR(time, 1, 1e-14);
    }
}

TEST(Calendar, RoundingDoesNotCostAWindow) {
    Calendar calendar(scene(2.1, 2.1, 0, {})); // 2.1 / 0.7 is 3.0000000000000004
    EXPECT_EQ(calendar.next(0.7, 16).count(), 3u);
}

TEST(Calendar, AFixedWindowOverrulesTheStableStep) {
    v1::Scene s = scene(1, 1, 0, {});
    s.mutable_time()->set_window(0.25);
    Calendar calendar(s);
    EXPECT_EQ(calendar.next(0.001, 16).count(), 4u);
}

TEST(Calendar, ACollapsedStepIsRefused) {
    Calendar calendar(scene(1, 1, 0, {}));
    EXPECT_THROW(calendar.next(1e-12, 16), std::runtime_error);
}

} // namespace
} // namespace duet::orchestrator
