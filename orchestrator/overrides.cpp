#include "orchestrator/overrides.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

namespace duet::orchestrator {

namespace {

/// One step of a path: a key or, if the key is empty, an index.
struct Step {
    std::string key;
    std::size_t index = 0;
};

std::invalid_argument bad_path(const std::string& path) {
    return std::invalid_argument("cannot read the key '" + path
                                 + "'; it is written like solid.body[0].element_size");
}

std::vector<Step> steps_of(const std::string& path) {
    std::vector<Step> steps;
    std::size_t at = 0;
    const auto take = [&](auto accepts) {
        const std::size_t start = at;
        while (at < path.size() && accepts(static_cast<unsigned char>(path[at])))
            ++at;
        return path.substr(start, at - start);
    };
    const auto letter = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
    const auto digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    while (at < path.size()) {
        if (path[at] == '[') {
            ++at;
            const std::string index = take(digit);
            if (steps.empty() || index.empty() || index.size() > 6 || at == path.size()
                || path[at] != ']')
                throw bad_path(path);
            ++at;
            steps.push_back({"", std::stoul(index)});
            continue;
        }
        if (!steps.empty() && path[at++] != '.')
            throw bad_path(path);
        const std::string key = take(letter);
        if (key.empty())
            throw bad_path(path);
        steps.push_back({key});
    }
    if (steps.empty())
        throw bad_path(path);
    return steps;
}

/// The entry of `node` at `step`, or where it has none, `fresh` put there.
template <class Value>
toml::node& entry(toml::node& node, const Step& step, Value&& fresh, bool replace) {
    if (!step.key.empty()) {
        toml::table* table = node.as_table();
        if (!table)
            throw std::invalid_argument("there is no table that could hold '" + step.key + "'");
        if (replace || !table->contains(step.key))
            table->insert_or_assign(step.key, std::forward<Value>(fresh));
        return *table->get(step.key);
    }
    toml::array* array = node.as_array();
    if (!array || step.index > array->size())
        throw std::invalid_argument("there is no entry [" + std::to_string(step.index)
                                    + "]: the array has "
                                    + std::to_string(array ? array->size() : 0) + " entries");
    if (step.index == array->size())
        array->push_back(std::forward<Value>(fresh));
    else if (replace)
        array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(step.index),
                       std::forward<Value>(fresh));
    return *array->get(step.index);
}

} // namespace

std::string apply_override(toml::table& root, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
        throw std::invalid_argument("expected KEY=VALUE");
    const std::string path = text.substr(0, equals);
    const std::vector<Step> steps = steps_of(path);

    toml::table parsed;
    try {
        parsed = toml::parse("value = " + text.substr(equals + 1));
    } catch (const toml::parse_error&) {
        const std::string word = text.substr(equals + 1); // parallel: a string without its quotes
        if (!word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
                return std::isalnum(c) || std::strchr("_-./", c);
            }))
            parsed.insert("value", word);
    }
    toml::node* value = parsed.get("value");
    if (!value || parsed.size() != 1)
        throw std::invalid_argument("the value '" + text.substr(equals + 1)
                                    + "' is not TOML: a string needs double quotes, a pair is "
                                      "[x, y]");

    toml::node* at = &root;
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
        if (steps[i + 1].key.empty())
            at = &entry(*at, steps[i], toml::array{}, false);
        else
            at = &entry(*at, steps[i], toml::table{}, false);
    }
    std::move(*value).visit([&](auto&& node) { entry(*at, steps.back(), std::move(node), true); });
    return path;
}

} // namespace duet::orchestrator
