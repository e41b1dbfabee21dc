#include "protocol/probe.hpp"

#include <algorithm>
#include <cmath>

namespace duet::protocol {

bool is_field_probe(const v1::Probe& probe) {
    return probe.has_at() || probe.line_size() == 2;
}

std::vector<v1::Vector> probe_points(const v1::Probe& probe) {
    std::vector<v1::Vector> points;
    if (probe.line_size() == 2) {
        const auto& a = probe.line(0);
        const auto& b = probe.line(1);
        const auto count = std::max(2u, probe.points());
        for (unsigned i = 0; i < count; ++i) {
            const double s = static_cast<double>(i) / (count - 1);
            auto& point = points.emplace_back();
            point.set_x((1 - s) * a.x() + s * b.x());
            point.set_y((1 - s) * a.y() + s * b.y());
        }
    } else if (probe.has_at()) {
        points.push_back(probe.at());
    }
    if (probe.has_mirror()) {
        const auto count = points.size();
        for (std::size_t i = 0; i < count; ++i) {
            auto image = points[i];
            image.set_x(2 * probe.mirror() - image.x());
            points.push_back(image);
        }
    }
    return points;
}

v1::Sample integral_sample(const v1::Probe& probe, double time, double value) {
    v1::Sample sample;
    sample.set_probe(probe.name());
    sample.set_time(time);
    sample.add_value(value);
    return sample;
}

v1::Sample
field_sample(const v1::Probe& probe, double time, std::span<const double> values, bool odd) {
    const std::size_t count = probe.has_mirror() ? values.size() / 2 : values.size();
    double length = 0;
    if (probe.line_size() == 2) {
        length = std::hypot(probe.line(1).x() - probe.line(0).x(),
                            probe.line(1).y() - probe.line(0).y());
    }

    std::vector<double> position, kept;
    for (std::size_t i = 0; i < count; ++i) {
        double value = values[i];
        if (probe.has_mirror()) {
            value = 0.5 * (value + (odd ? -values[count + i] : values[count + i]));
        }
        if (std::isfinite(value)) {
            position.push_back(
                count > 1 ? length * static_cast<double>(i) / static_cast<double>(count - 1) : 0);
            kept.push_back(value);
        }
    }

    v1::Sample sample;
    sample.set_probe(probe.name());
    sample.set_time(time);
    if (kept.empty()) {
        return sample;
    }
    const bool line = probe.line_size() == 2;
    if (!line) {
        sample.add_value(kept.front());
        return sample;
    }
    switch (probe.reduce()) {
    case v1::Probe::MAXIMUM:
        sample.add_value(*std::max_element(kept.begin(), kept.end()));
        break;
    case v1::Probe::MINIMUM:
        sample.add_value(*std::min_element(kept.begin(), kept.end()));
        break;
    case v1::Probe::MEAN: {
        double integral = 0, width = 0;
        for (std::size_t i = 1; i < kept.size(); ++i) {
            integral += 0.5 * (kept[i] + kept[i - 1]) * (position[i] - position[i - 1]);
            width += position[i] - position[i - 1];
        }
        sample.add_value(width > 0 ? integral / width : kept.front());
        break;
    }
    case v1::Probe::DIFFERENCE:
        if (position.front() == 0 && position.back() == length) { // both ends are in the domain
            sample.add_value(kept.back() - kept.front());
        }
        break;
    default:
        sample.mutable_value()->Add(kept.begin(), kept.end());
        sample.mutable_position()->Add(position.begin(), position.end());
    }
    return sample;
}

} // namespace duet::protocol
