#include "orchestrator/verify.hpp"

#include "orchestrator/figures.hpp"
#include "orchestrator/progress.hpp"
#include "orchestrator/reference_table.hpp"
#include "orchestrator/schema.hpp"
#include "orchestrator/summary.hpp"
#include "protocol/version.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>

namespace duet::orchestrator {

namespace {

/// What was measured, over time or along a line, beside the reference at the same places.
struct Pairs {
    std::vector<double> value;
    std::vector<double> reference;
};

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

double error_of(const Pairs& pairs, v1::Check::Norm norm) {
    double squares = 0;
    double largest = 0;
    for (std::size_t i = 0; i < pairs.value.size(); ++i) {
        const double difference = std::abs(pairs.value[i] - pairs.reference[i]);
        squares += difference * difference;
        largest = std::max(largest, difference);
        if (std::isnan(difference))
            return difference;
    }
    switch (norm) {
    case v1::Check::RMS:
        return std::sqrt(squares / static_cast<double>(pairs.value.size()));
    case v1::Check::RELATIVE:
        return largest / std::abs(pairs.reference.front());
    default:
        return largest; // ABSOLUTE has one pair alone
    }
}

/// What a check holds the run against: a number, or a column of a file.
class Reference {
  public:
    explicit Reference(const v1::Check& check) : check_(check) {
        if (!check.has_value())
            table_.emplace(check.reference());
    }
    double at(double along) const {
        const double unscaled =
            table_ ? table_->interpolate(check_.column(), check_.along(), along) : check_.value();
        return check_.scale() * unscaled;
    }

  private:
    const v1::Check& check_;
    std::optional<ReferenceTable> table_;
};

class Judge {
  public:
    Judge(const Case& given, const RunResult& result)
        : scene_(given.scene), result_(result), figures_(figures_of(result)) {}

    void judge(const v1::Check& check, std::vector<Verdict>& out) const;

  private:
    Pairs figure(const v1::Check& check) const;
    Pairs at_time(const v1::Check& check, const v1::Probe& probe, double time) const;
    Pairs mean_until(const v1::Check& check, const v1::Probe& probe, double time) const;
    Pairs over_times(const v1::Check& check, const v1::Probe& probe) const;

    const v1::Scene& scene_;
    const RunResult& result_;
    std::map<std::string, double> figures_;
};

Pairs Judge::figure(const v1::Check& check) const {
    const auto found = figures_.find(check.quantity());
    if (found == figures_.end())
        throw std::runtime_error("the run has no audit figure '" + check.quantity() + "'");
    return {{found->second}, {Reference(check).at(scene_.time().end())}};
}

/// The entry of a series at a time that the calendar has made a mark, to rounding.
template <class Series, class TimeOf>
const auto& entry_at(const Series& series, double time, double slack, TimeOf time_of) {
    for (const auto& entry : series)
        if (std::abs(time_of(entry) - time) <= slack)
            return entry;
    throw std::runtime_error("nothing was recorded at t = " + number_text(time) + " s");
}

Pairs Judge::at_time(const v1::Check& check, const v1::Probe& probe, double time) const {
    const double slack = 1e-8 * scene_.time().end();
    if (!is_profile(probe)) {
        const auto found = result_.histories.find(probe.name());
        if (found == result_.histories.end())
            throw std::runtime_error("the solver sent no values");
        const History& history = found->second;
        const double& found_time = entry_at(history.time, time, slack, [](double t) { return t; });
        const auto i = static_cast<std::size_t>(&found_time - history.time.data());
        return {{history.value[i]}, {Reference(check).at(time)}};
    }
    const auto found = result_.profiles.find(probe.name());
    if (found == result_.profiles.end())
        throw std::runtime_error("the solver sent no values");
    const Profile& profile =
        entry_at(found->second, time, slack, [](const Profile& one) { return one.time; });
    const Reference reference(check);
    Pairs pairs;
    for (std::size_t j = 0; j < profile.value.size(); ++j) {
        pairs.value.push_back(profile.value[j]);
        pairs.reference.push_back(reference.at(profile.position[j]));
    }
    return pairs;
}

/// The mean over time from check.mean_from to `time` by the trapezoidal rule over the records, a
/// profile's point by point.
Pairs Judge::mean_until(const v1::Check& check, const v1::Probe& probe, double time) const {
    const double slack = 1e-8 * scene_.time().end();
    std::vector<double> times;
    const auto take = [&](double t) {
        if (t >= check.mean_from() - slack && t <= time + slack)
            times.push_back(t);
    };
    if (const auto found = result_.histories.find(probe.name()); found != result_.histories.end())
        for (const double t : found->second.time)
            take(t);
    if (const auto found = result_.profiles.find(probe.name()); found != result_.profiles.end())
        for (const Profile& profile : found->second)
            take(profile.time);
    Pairs sum = at_time(check, probe, time);
    std::fill(sum.value.begin(), sum.value.end(), 0.0);
    const double span = times.empty() ? 0 : times.back() - times.front();
    for (std::size_t k = 0; k < times.size(); ++k) {
        const double before = times[k == 0 ? k : k - 1];
        const double after = times[k + 1 == times.size() ? k : k + 1];
        const double weight = span > 0 ? 0.5 * (after - before) / span : 1;
        const Pairs one = at_time(check, probe, times[k]);
        if (one.value.size() != sum.value.size())
            throw std::runtime_error(
                "the line's points in the domain changed in the time of the mean");
        for (std::size_t i = 0; i < sum.value.size(); ++i)
            sum.value[i] += weight * one.value[i];
    }
    return sum;
}

/// A history as a whole: at the times named, or else wherever it was recorded after the start, from
/// the time on that the check names.
Pairs Judge::over_times(const v1::Check& check, const v1::Probe& probe) const {
    std::vector<double> times;
    for (const double t : check.at())
        if (t >= check.from())
            times.push_back(t);
    if (const auto found = result_.histories.find(probe.name());
        times.empty() && found != result_.histories.end())
        for (const double t : found->second.time)
            if (t > 0 && t >= check.from())
                times.push_back(t);
    Pairs pairs;
    for (const double t : times) {
        const Pairs one = at_time(check, probe, t);
        pairs.value.push_back(one.value.front());
        pairs.reference.push_back(one.reference.front());
    }
    return pairs;
}

void Judge::judge(const v1::Check& check, std::vector<Verdict>& out) const {
    const auto add = [&](const std::string& when, const std::function<Pairs()>& measure) {
        Verdict verdict;
        verdict.quantity = check.quantity() + when;
        verdict.tolerance = check.tolerance();
        verdict.judged = check.judged();
        verdict.why = check.why();
        try {
            const Pairs pairs = measure();
            if (pairs.value.empty())
                throw std::runtime_error("nothing was recorded");
            verdict.value = mean(pairs.value);
            verdict.reference = mean(pairs.reference);
            verdict.error = error_of(pairs, check.norm());
            verdict.pass = verdict.error <= verdict.tolerance; // false for NaN
        } catch (const std::runtime_error& error) {
            verdict.value = verdict.error = std::numeric_limits<double>::quiet_NaN();
            verdict.problem = error.what();
        }
        out.push_back(verdict);
    };

    const auto& probes = scene_.probe();
    const auto probe = std::find_if(probes.begin(), probes.end(), [&](const v1::Probe& one) {
        return one.name() == check.quantity();
    });
    if (probe == probes.end())
        return add("", [&] { return figure(check); });
    const bool rms = check.norm() == v1::Check::RMS;
    const bool whole = rms || check.norm() == v1::Check::MAXIMUM;
    const std::string norm = whole ? (rms ? ", rms" : ", maximum") : "";
    if (whole && !is_profile(*probe))
        return add(" over time" + norm, [&] { return over_times(check, *probe); });
    std::vector<double> times(check.at().begin(), check.at().end());
    if (times.empty())
        times.push_back(scene_.time().end());
    for (const double time : times)
        if (check.has_mean_from())
            add(", mean of " + number_text(check.mean_from()) + " to " + number_text(time) + " s"
                    + norm,
                [&] { return mean_until(check, *probe, time); });
        else
            add(" at " + number_text(time) + " s" + norm,
                [&] { return at_time(check, *probe, time); });
}

std::string cell(const char* pattern, double value) {
    char text[40];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

std::string verdict_word(const Verdict& verdict) {
    if (!verdict.problem.empty())
        return verdict.judged ? "FAIL: " + verdict.problem : "no value: " + verdict.problem;
    if (!verdict.judged)
        return verdict.pass ? "reported (within)" : "reported (beyond)";
    return verdict.pass ? "pass" : "FAIL";
}

std::string megabytes(std::uint64_t bytes) {
    return cell("%.0f MB", static_cast<double>(bytes) / 1e6);
}

} // namespace

std::vector<Verdict> judge(const Case& given, const RunResult& result) {
    std::vector<Verdict> verdicts;
    const Judge judge(given, result);
    for (const v1::Check& check : given.scene.check())
        judge.judge(check, verdicts);
    return verdicts;
}

bool all_pass(const std::vector<Verdict>& verdicts) {
    return std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& verdict) {
        return verdict.pass || !verdict.judged;
    });
}

std::string verdict_table(const std::vector<Verdict>& verdicts, const RunResult& result) {
    std::vector<std::array<std::string, 6>> rows = {
        {"quantity", "value", "reference", "error", "tolerance", "verdict"}};
    for (const Verdict& v : verdicts)
        rows.push_back({v.quantity,
                        cell("%.7g", v.value),
                        cell("%.7g", v.reference),
                        cell("%.3g", v.error),
                        cell("%.3g", v.tolerance),
                        verdict_word(v)});
    std::array<std::size_t, 6> width{};
    for (const auto& row : rows)
        for (std::size_t i = 0; i + 1 < row.size(); ++i)
            width[i] = std::max(width[i], row[i].size());
    std::string out;
    for (const auto& row : rows) {
        out += row[0] + std::string(width[0] - row[0].size(), ' ');
        for (std::size_t i = 1; i + 1 < row.size(); ++i)
            out += "  " + std::string(width[i] - row[i].size(), ' ') + row[i];
        out += "  " + row.back() + "\n";
    }
    out += "\ncost:";
    for (const Player& player : result.players)
        out += " " + protocol::name_of(player.role) + " " + cell("%.1f", cpu_seconds(player))
               + " CPU s (" + megabytes(peak_memory(player)) + ", "
               + cell("%.1f", 100 * waiting_share(player)) + " % waiting),";
    return out + " wall " + duration_text(result.wall_seconds) + ", "
           + std::to_string(result.windows) + " windows\n";
}

std::string
verdict_json(const Case& given, const std::vector<Verdict>& verdicts, const RunResult& result) {
    using Json = nlohmann::ordered_json;
    Json json = {{"case", given.name}, {"revision", revision()}, {"checks", Json::array()}};
    for (const Verdict& v : verdicts) {
        json["checks"].push_back({{"quantity", v.quantity},
                                  {"value", v.value},
                                  {"reference", v.reference},
                                  {"error", v.error},
                                  {"tolerance", v.tolerance},
                                  {"pass", v.pass},
                                  {"judged", v.judged},
                                  {"why", v.why}});
        if (!v.problem.empty())
            json["checks"].back()["problem"] = v.problem;
    }
    for (const Player& player : result.players) {
        json["cpu_seconds"][protocol::name_of(player.role)] = cpu_seconds(player);
        json["peak_memory_bytes"][protocol::name_of(player.role)] = peak_memory(player);
    }
    json["wall_seconds"] = result.wall_seconds;
    json["balances"] = balances_json(result.balances);
    return json.dump(2) + "\n";
}

} // namespace duet::orchestrator
