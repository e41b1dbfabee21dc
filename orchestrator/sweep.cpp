#include "orchestrator/sweep.hpp"

#include "orchestrator/schema.hpp"
#include "orchestrator/summary.hpp"
#include "protocol/version.hpp"

#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace duet::orchestrator {

namespace {

using Json = nlohmann::ordered_json;

/// The field that a path names, without its indices; null if there is none.
const Field* field_at(const std::string& path) {
    const Table* table = v1::Scene::descriptor();
    const Field* field = nullptr;
    std::istringstream parts(path);
    for (std::string part; std::getline(parts, part, '.');) {
        field = table ? table->FindFieldByName(part.substr(0, part.find('['))) : nullptr;
        if (!field)
            return nullptr;
        table = field->message_type();
    }
    return field;
}

/// How deep the brackets of one value of the key go: 1 for a pair [x, y].
int depth_of_one(const Field& field, bool indexed) {
    const Kind kind = kind_of(field);
    const bool pair = kind == Kind::vector || kind == Kind::vector_function;
    return (pair ? 1 : 0) + (field.is_repeated() && !indexed ? 1 : 0);
}

int depth_of(const toml::node& node) {
    const toml::array* array = node.as_array();
    return array && !array->empty() ? 1 + depth_of(*array->get(0)) : 0;
}

std::string text_of(const toml::node& node) {
    if (const auto number = node.value_exact<double>())
        return number_text(*number);
    std::ostringstream out;
    node.visit([&](const auto& one) { out << toml::toml_formatter{one}; });
    return out.str();
}

/// The values of an override that is a list of what the key takes; nothing if it is one value.
std::vector<std::string> listed_values(const std::string& key, const std::string& value) {
    const Field* field = field_at(key);
    toml::table parsed;
    try {
        parsed = toml::parse("value = " + value);
    } catch (const toml::parse_error&) {
        return {}; // read_case() says what is wrong with it
    }
    const toml::node& node = *parsed.get("value");
    if (!field || depth_of(node) <= depth_of_one(*field, key.back() == ']'))
        return {};
    std::vector<std::string> values;
    for (const toml::node& one : *node.as_array())
        values.push_back(text_of(one));
    return values;
}

/// Commas and quotes would break the table.
std::string csv_field(std::string text) {
    for (char& c : text)
        c = c == ',' ? ';' : c == '"' ? '\'' : c;
    return text;
}

/// A string value without its quotes.
std::string bare(const std::string& value) {
    const bool quoted = value.size() >= 2 && (value.front() == '"' || value.front() == '\'')
                        && value.back() == value.front();
    return quoted ? value.substr(1, value.size() - 2) : value;
}

std::string ended_word(const RunResult& result) {
    return result.ended == Ended::finished ? "finished"
           : result.ended == Ended::failed ? "failed"
                                           : "interrupted";
}

} // namespace

std::vector<Variant> variants_of(const std::vector<std::string>& overrides) {
    std::vector<Variant> variants(1);
    for (const std::string& text : overrides) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0)
            throw std::invalid_argument("--set " + text + ": expected KEY=VALUE");
        const std::string key = text.substr(0, equals);
        std::vector<std::string> values = listed_values(key, text.substr(equals + 1));
        const bool varies = !values.empty(); // also a list of one: its table goes with others
        if (!varies)
            values = {text.substr(equals + 1)};
        for (const auto& [varied, value] : variants.front().varied)
            if (varied == key)
                throw std::invalid_argument("--set " + text + ": the key varies already");
        std::vector<Variant> longer;
        for (const Variant& variant : variants)
            for (const std::string& value : values) {
                Variant& next = longer.emplace_back(variant);
                next.overrides.push_back(key + "=" + value);
                if (varies)
                    next.varied.emplace_back(key, value);
            }
        variants = std::move(longer);
    }
    return variants;
}

std::string sweep_csv(const std::vector<Trial>& trials) {
    std::ostringstream out;
    out.precision(9);
    for (const auto& [key, value] : trials.at(0).variant.varied)
        out << csv_field(key) << ",";
    // A variant may be held at other times than the first: all that any of them has.
    std::vector<std::string> checks;
    for (const Trial& trial : trials)
        for (const Verdict& verdict : trial.verdicts)
            if (std::find(checks.begin(), checks.end(), verdict.quantity) == checks.end())
                checks.push_back(verdict.quantity);
    for (const std::string& check : checks)
        out << csv_field("error of " + check) << ",";
    for (const Player& player : trials[0].result.players)
        out << "cpu_seconds_" << protocol::name_of(player.role) << ",steps_"
            << protocol::name_of(player.role) << ",";
    out << "wall_seconds,ended,revision\n";
    for (const Trial& trial : trials) {
        for (const auto& [key, value] : trial.variant.varied)
            out << csv_field(bare(value)) << ",";
        for (const std::string& check : checks) {
            const auto found =
                std::find_if(trial.verdicts.begin(),
                             trial.verdicts.end(),
                             [&](const Verdict& verdict) { return verdict.quantity == check; });
            if (found != trial.verdicts.end())
                out << found->error;
            out << ",";
        }
        for (const Player& player : trial.result.players)
            out << cpu_seconds(player) << "," << player.steps << ",";
        out << trial.result.wall_seconds << "," << ended_word(trial.result) << "," << revision()
            << "\n";
    }
    return out.str();
}

std::string sweep_json(const Case& given, const std::vector<Trial>& trials) {
    Json json = {{"case", given.name}, {"revision", revision()}, {"trials", Json::array()}};
    for (const Trial& trial : trials) {
        Json one = {{"ended", ended_word(trial.result)},
                    {"failure", trial.result.failure},
                    {"folder", trial.result.folder.string()},
                    {"wall_seconds", trial.result.wall_seconds}};
        for (const auto& [key, value] : trial.variant.varied)
            one["varied"][key] = bare(value);
        for (const Player& player : trial.result.players) {
            const std::string who = protocol::name_of(player.role);
            one["cpu_seconds"][who] = cpu_seconds(player);
            one["steps"][who] = player.steps;
        }
        for (const Verdict& v : trial.verdicts)
            one["checks"].push_back({{"quantity", v.quantity},
                                     {"value", v.value},
                                     {"reference", v.reference},
                                     {"error", v.error},
                                     {"tolerance", v.tolerance},
                                     {"pass", v.pass}});
        json["trials"].push_back(one);
    }
    return json.dump(2) + "\n";
}

} // namespace duet::orchestrator
