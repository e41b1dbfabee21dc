#include "orchestrator/schema.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <numeric>

namespace duet::orchestrator {

Kind kind_of(const Field& field) {
    switch (field.cpp_type()) {
    case Field::CPPTYPE_DOUBLE:
        return Kind::number;
    case Field::CPPTYPE_BOOL:
        return Kind::boolean;
    case Field::CPPTYPE_STRING:
        return Kind::text;
    case Field::CPPTYPE_ENUM:
        return Kind::choice;
    case Field::CPPTYPE_MESSAGE:
        if (field.message_type() == v1::Vector::descriptor())
            return Kind::vector;
        if (field.message_type() == v1::Function::descriptor())
            return Kind::function;
        if (field.message_type() == v1::VectorFunction::descriptor())
            return Kind::vector_function;
        return Kind::table;
    default:
        return Kind::whole_number; // scene.proto has uint32 besides
    }
}

const v1::Key& key_of(const Field& field) {
    return field.options().GetExtension(v1::key);
}

std::string expected(const Field& field) {
    const bool many = field.is_repeated();
    switch (kind_of(field)) {
    case Kind::number:
        return many ? "an array of numbers" : "a number";
    case Kind::whole_number:
        return many ? "an array of whole numbers" : "a whole number, 0 or greater";
    case Kind::boolean:
        return many ? "an array of true or false" : "true or false";
    case Kind::text:
        return many ? "an array of strings" : "a string";
    case Kind::choice:
        return "one of the strings " + list(choices(field));
    case Kind::vector:
        return many ? "an array of pairs [x, y]" : "a pair of numbers [x, y]";
    case Kind::function:
        return "a number, a formula in x, y and t, or a table in time";
    case Kind::vector_function:
        return "a pair [x, y] of numbers, formulas or tables in time";
    case Kind::table:
        return many ? "an array of tables" : "a table";
    }
    return {};
}

std::string range_of(const Field& field) {
    const v1::Key& key = key_of(field);
    std::vector<std::string> parts;
    if (key.has_minimum())
        parts.push_back("at least " + number_text(key.minimum()));
    if (key.has_above())
        parts.push_back("greater than " + number_text(key.above()));
    if (key.has_maximum())
        parts.push_back("at most " + number_text(key.maximum()));
    if (key.has_below())
        parts.push_back("less than " + number_text(key.below()));
    return list(parts, "and");
}

std::optional<std::string> range_broken(const Field& field, double value) {
    const v1::Key& key = key_of(field);
    const bool inside = (!key.has_minimum() || value >= key.minimum())
                        && (!key.has_above() || value > key.above())
                        && (!key.has_maximum() || value <= key.maximum())
                        && (!key.has_below() || value < key.below());
    if (inside)
        return std::nullopt;
    return "must be " + range_of(field) + ", not " + number_text(value);
}

std::vector<std::string> choices(const Field& field) {
    std::vector<std::string> names;
    for (int i = 0; i < field.enum_type()->value_count(); ++i) {
        std::string name = field.enum_type()->value(i)->name();
        std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
            return static_cast<char>(std::tolower(c));
        });
        names.push_back(name);
    }
    return names;
}

bool always_present(const Table& table) {
    for (int i = 0; i < table.field_count(); ++i)
        if (key_of(*table.field(i)).required())
            return false;
    return &table != v1::Vector::descriptor();
}

std::string number_text(double value) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
}

std::string list(const std::vector<std::string>& names, const std::string& last) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0)
            text += i + 1 == names.size() ? " " + last + " " : ", ";
        text += names[i];
    }
    return text;
}

namespace {

/// Levenshtein's distance: the least number of letters to insert, delete or replace.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

} // namespace

std::optional<std::string> nearest(const std::string& word, const std::vector<std::string>& names) {
    std::optional<std::string> best;
    std::size_t least = 0;
    for (const std::string& name : names) {
        // A key that holds the word whole, or is held by it, is meant more often than one of equal
        // length: "viscosity" for "kinematic_viscosity".
        const bool part = word.size() >= 4
                          && (name.find(word) != std::string::npos
                              || (name.size() >= 4 && word.find(name) != std::string::npos));
        const std::size_t distance = part ? 1 : edit_distance(word, name);
        const std::size_t near = std::max<std::size_t>(2, std::max(word.size(), name.size()) / 3);
        if (distance <= near && (!best || distance < least)) {
            best = name;
            least = distance;
        }
    }
    return best;
}

} // namespace duet::orchestrator
