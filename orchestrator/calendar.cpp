#include "orchestrator/calendar.hpp"

#include "orchestrator/schema.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace duet::orchestrator {

namespace {

/// Times k * interval, k = 1, 2, ..., below `end`, to twelve digits: 0.15, not 0.15000000000000002.
template <class Put>
void every(double interval, double end, Put put) {
    if (interval <= 0)
        return;
    for (std::uint64_t k = 1; static_cast<double>(k) * interval < end; ++k) {
        char text[32];
        std::snprintf(text, sizeof text, "%.12g", static_cast<double>(k) * interval);
        put(std::strtod(text, nullptr));
    }
}

} // namespace

std::vector<Mark> marks_of(const v1::Scene& scene) {
    const double end = scene.time().end();
    const double given = scene.output().probe_interval();
    std::vector<Mark> marks;
    if (scene.probe_size() > 0)
        every(given > 0 ? given : end / 100, end, [&](double t) {
            marks.push_back({t, true, false});
        });
    every(scene.output().interval(), end, [&](double t) { marks.push_back({t, false, true}); });
    for (const v1::Check& check : scene.check())
        for (const double t : check.at())
            if (t > 0)
                marks.push_back({t, true, false});
    marks.push_back({end, true, true});

    std::sort(
        marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.time < b.time; });
    std::vector<Mark> merged; // times that differ by rounding alone are one mark
    for (const Mark& mark : marks) {
        if (merged.empty() || mark.time - merged.back().time > 1e-9 * end) {
            merged.push_back(mark);
            continue;
        }
        merged.back().sample |= mark.sample;
        merged.back().snapshot |= mark.snapshot;
    }
    merged.back().time = end;
    return merged;
}

Calendar::Calendar(const v1::Scene& scene)
    : marks_(marks_of(scene)), fixed_window_(scene.time().window()) {}

v1::Lease Calendar::next(double stable, std::uint32_t most) {
    const Mark& mark = marks_[next_mark_];
    const double remaining = mark.time - time_;
    // Without any limit still a hundred windows: a run is watched, and can be stopped, at their
    // ends.
    const double unlimited = marks_.back().time / 100;
    const double longest = fixed_window_ > 0 ? fixed_window_ : stable > 0 ? stable : unlimited;
    // Rounding must not cost a window.
    const double count = std::max(1.0, std::ceil(remaining / longest * (1 - 1e-9)));
    if (!(count < 1e9))
        throw std::runtime_error("windows of " + number_text(longest)
                                 + " s would be too many; the solvers' stable step has collapsed");

    v1::Lease lease;
    lease.set_first(window_);
    lease.set_count(std::min(most, static_cast<std::uint32_t>(count)));
    lease.set_time(time_);
    lease.set_length(remaining / count);
    window_ += lease.count();
    if (static_cast<double>(lease.count()) < count) {
        time_ += lease.count() * lease.length();
        return lease;
    }
    time_ = mark.time;
    lease.set_sample(mark.sample);
    lease.set_snapshot(mark.snapshot);
    ++next_mark_;
    return lease;
}

} // namespace duet::orchestrator
