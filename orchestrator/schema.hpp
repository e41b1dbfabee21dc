// What scene.proto says about one key of the case file: read from the field's descriptor and its
// option (duet.v1.key).

#pragma once

#include "duet/v1/scene.pb.h"

#include <google/protobuf/descriptor.h>

#include <optional>
#include <string>
#include <vector>

namespace duet::orchestrator {

using Field = google::protobuf::FieldDescriptor;
using Table = google::protobuf::Descriptor;

/// Kind of value that a key takes.
enum class Kind {
    number,
    whole_number,
    boolean,
    text,
    choice,
    vector,
    function,
    vector_function,
    table
};

Kind kind_of(const Field& field);

/// The option (key) of a field: help, unit, range, default.
const v1::Key& key_of(const Field& field);

/// "a number", "an array of pairs [x, y]": what a value of this key is, for sentences.
std::string expected(const Field& field);

/// "greater than 0, at most 0.4"; empty without a range.
std::string range_of(const Field& field);

/// The sentence that breaks the range, or nothing.
std::optional<std::string> range_broken(const Field& field, double value);

/// The names of an enumeration in lower case, in the order of their numbers.
std::vector<std::string> choices(const Field& field);

/// A table that has no required key is always there, filled with its defaults.
bool always_present(const Table& table);

/// The shortest decimal text that reads back as the same number.
std::string number_text(double value);

/// The names as a list for a sentence: "a, b or c".
std::string list(const std::vector<std::string>& names, const std::string& last = "or");

/// The name nearest to `word` by edit distance, if it is near enough to be meant.
std::optional<std::string> nearest(const std::string& word, const std::vector<std::string>& names);

} // namespace duet::orchestrator
