// The scene back as a case file, and the page that documents every key.

#include "orchestrator/case_file.hpp"
#include "orchestrator/figures.hpp"
#include "orchestrator/schema.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace duet::orchestrator {

namespace {

using google::protobuf::Message;

std::string toml_string(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out += '\\';
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
            char code[8];
            std::snprintf(code, sizeof code, "\\u%04X", static_cast<unsigned>(c));
            out += code;
        } else {
            out += c;
        }
    }
    return out + "\"";
}

std::string pair_text(const Message& message) {
    const auto& vector = static_cast<const v1::Vector&>(message);
    return "[" + number_text(vector.x()) + ", " + number_text(vector.y()) + "]";
}

std::string array_text(const google::protobuf::RepeatedField<double>& numbers) {
    std::string text = "[";
    for (int i = 0; i < numbers.size(); ++i)
        text += (i > 0 ? ", " : "") + number_text(numbers[i]);
    return text + "]";
}

std::string function_text(const v1::Function& function) {
    switch (function.kind_case()) {
    case v1::Function::kFormula:
        return toml_string(function.formula());
    case v1::Function::kTable:
        return "{ time = " + array_text(function.table().time())
               + ", value = " + array_text(function.table().value()) + " }";
    default:
        return number_text(function.number());
    }
}

/// The value of a key that is no table, as TOML; entry `i` of a repeated one.
std::string entry_text(const Message& m, const Field& field, int i) {
    const auto& r = *m.GetReflection();
    const bool many = field.is_repeated();
    switch (kind_of(field)) {
    case Kind::number:
        return number_text(many ? r.GetRepeatedDouble(m, &field, i) : r.GetDouble(m, &field));
    case Kind::whole_number:
        return std::to_string(r.GetUInt32(m, &field));
    case Kind::boolean:
        return r.GetBool(m, &field) ? "true" : "false";
    case Kind::text:
        return toml_string(many ? r.GetRepeatedString(m, &field, i) : r.GetString(m, &field));
    case Kind::choice:
        return toml_string(choices(field)[static_cast<std::size_t>(r.GetEnum(m, &field)->index())]);
    case Kind::vector:
        return pair_text(many ? r.GetRepeatedMessage(m, &field, i) : r.GetMessage(m, &field));
    case Kind::function:
        return function_text(static_cast<const v1::Function&>(r.GetMessage(m, &field)));
    case Kind::vector_function: {
        const auto& pair = static_cast<const v1::VectorFunction&>(r.GetMessage(m, &field));
        return "[" + function_text(pair.x()) + ", " + function_text(pair.y()) + "]";
    }
    case Kind::table:
        break;
    }
    return {};
}

std::string value_text(const Message& m, const Field& field) {
    if (!field.is_repeated())
        return entry_text(m, field, 0);
    std::string text = "[";
    for (int i = 0; i < m.GetReflection()->FieldSize(m, &field); ++i)
        text += (i > 0 ? ", " : "") + entry_text(m, field, i);
    return text + "]";
}

bool given(const Message& m, const Field& field) {
    const auto& r = *m.GetReflection();
    return field.is_repeated() ? r.FieldSize(m, &field) > 0 : r.HasField(m, &field);
}

std::string comment(const Field& field) {
    const v1::Key& key = key_of(field);
    const std::string unit = key.unit().empty() ? "" : key.unit() + ": ";
    return "  # " + unit + key.help();
}

/// All keys that are no tables first: in TOML they belong to the heading above them.
void write_table(const Message& m, const std::string& path, std::string& out) {
    const Table& descriptor = *m.GetDescriptor();
    std::vector<std::pair<std::string, const Field*>> lines;
    std::size_t width = 0;
    for (int i = 0; i < descriptor.field_count(); ++i) {
        const Field& field = *descriptor.field(i);
        if (kind_of(field) == Kind::table || !given(m, field))
            continue;
        lines.emplace_back(field.name() + " = " + value_text(m, field), &field);
        width = std::max(width, std::min<std::size_t>(lines.back().first.size(), 40));
    }
    for (auto& [line, field] : lines) {
        line.resize(std::max(line.size(), width), ' ');
        out += line + comment(*field) + "\n";
    }
    for (int i = 0; i < descriptor.field_count(); ++i) {
        const Field& field = *descriptor.field(i);
        if (kind_of(field) != Kind::table || !given(m, field))
            continue;
        const std::string at = path.empty() ? field.name() : path + "." + field.name();
        const auto& r = *m.GetReflection();
        if (!field.is_repeated()) {
            out += "\n[" + at + "]\n";
            write_table(r.GetMessage(m, &field), at, out);
        }
        for (int j = 0; field.is_repeated() && j < r.FieldSize(m, &field); ++j) {
            out += "\n[[" + at + "]]\n";
            write_table(r.GetRepeatedMessage(m, &field, j), at, out);
        }
    }
}

std::string code(const std::string& text) {
    return "`" + text + "`";
}

/// How a key's value looks, in a cell of the page.
std::string type_text(const Field& field) {
    std::string type;
    switch (kind_of(field)) {
    case Kind::number:
        type = "number";
        break;
    case Kind::whole_number:
        type = "whole number";
        break;
    case Kind::boolean:
        type = "true or false";
        break;
    case Kind::text:
        type = key_of(field).file() ? "file" : "string";
        break;
    case Kind::choice: {
        std::vector<std::string> names;
        for (const std::string& name : choices(field))
            names.push_back(code(toml_string(name)));
        return list(names);
    }
    case Kind::vector:
        type = "[x, y]";
        break;
    case Kind::function:
        return "function";
    case Kind::vector_function:
        return "[x, y] of functions";
    case Kind::table:
        type = "table";
        break;
    }
    return field.is_repeated() ? "array of " + type + (type == "[x, y]" ? "" : "s") : type;
}

std::string range_text(const Field& field) {
    const v1::Key& key = key_of(field);
    std::vector<std::string> parts;
    if (!range_of(field).empty())
        parts.push_back(range_of(field));
    if (key.minimum_count() > 0 && key.minimum_count() == key.maximum_count())
        parts.push_back(std::to_string(key.minimum_count()) + " entries");
    else if (key.minimum_count() > 0)
        parts.push_back("at least " + std::to_string(key.minimum_count()) + " entries");
    else if (key.maximum_count() > 0)
        parts.push_back("at most " + std::to_string(key.maximum_count()) + " entries");
    return list(parts, "and");
}

std::string default_text(const Field& field) {
    const v1::Key& key = key_of(field);
    if (key.required())
        return "required";
    if (!key.default_().empty())
        return code(key.default_());
    if (kind_of(field) == Kind::table && !field.is_repeated()
        && always_present(*field.message_type()))
        return "its defaults";
    return "absent";
}

/// The tables that a table holds follow it, each under its full name.
void document(const Table& table, const std::string& path, std::string& out) {
    out += "| key | type | unit | range | default | |\n|---|---|---|---|---|---|\n";
    for (int i = 0; i < table.field_count(); ++i) {
        const Field& field = *table.field(i);
        out += "| " + code(field.name()) + " | " + type_text(field) + " | " + key_of(field).unit()
               + " | " + range_text(field) + " | " + default_text(field) + " | "
               + key_of(field).help() + " |\n";
    }
    for (int i = 0; i < table.field_count(); ++i) {
        const Field& field = *table.field(i);
        if (kind_of(field) != Kind::table)
            continue;
        const std::string name = path.empty() ? field.name() : path + "." + field.name();
        out += "\n## " + code(field.is_repeated() ? "[[" + name + "]]" : "[" + name + "]") + "\n\n";
        document(*field.message_type(), name, out);
    }
}

} // namespace

std::string write_case(const v1::Scene& scene) {
    std::string out = "# Written by duet: every key of the run, defaults filled in.\n\n";
    write_table(scene, "", out);
    return out;
}

std::string case_file_reference() {
    std::string out = R"page(# The case file

Written by `duet reference` from `protocol/proto/duet/v1/scene.proto`; a test keeps it current.

A case is a folder with a file `case.toml` ([TOML](https://toml.io) 1.0). SI units throughout, two dimensions, plane
strain, per metre of depth; x points right, y up. A key may be replaced on the command line:
`--set fluid.spacing=0.2`, `--set solid.body[0].element_size=0.1`, `--set 'coupling.schedule="parallel"'`.
A table without required keys is always there, filled with its defaults; the others are absent until written.

A *function* is a number, a formula, or a table in time:

    temperature = 300
    temperature = "300 + 10*sin(pi*x)*(t < 2 ? t/2 : 1)"
    temperature = { time = [0, 0.5, 2], value = [300, 310, 305] }
    temperature = { file = "measured.csv", along = "t_s", column = "T_K" }

A formula may use the coordinates `x` and `y`, the time `t`, `pi`, the operators `+ - * / ^ < <= > >= == != && || ?:` and the functions
`sin cos tan asin acos atan atan2 sinh cosh tanh exp ln log10 sqrt abs sign rint min max`. A table is linear between its times and constant
beyond them; its file lies beside the case file.

## The top of the file

)page";
    document(*v1::Scene::descriptor(), "", out);
    out += "\n## Audit figures\n\nA `[[check]]` names a probe or one of these; besides them every "
           "number of a "
           "solver's ledger is there as\n`fluid.<number>` and `solid.<number>`, e.g. "
           "`fluid.kinetic_energy`.\n\n"
           "| figure | |\n|---|---|\n";
    for (const Figure& figure : audit_figures())
        out += "| " + code(figure.name) + " | " + figure.help + " |\n";
    return out;
}

} // namespace duet::orchestrator
