#include "orchestrator/case_file.hpp"

#include "orchestrator/overrides.hpp"
#include "orchestrator/reference_table.hpp"
#include "orchestrator/schema.hpp"
#include "protocol/function.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

namespace duet::orchestrator {

std::string Problem::text() const {
    if (place.line == 0)
        return place.source + ": " + sentence;
    return place.source + ":" + std::to_string(place.line) + ":" + std::to_string(place.column)
           + ": " + sentence;
}

namespace {

std::vector<Problem> in_order(std::vector<Problem> problems) {
    std::stable_sort(problems.begin(), problems.end(), [](const Problem& a, const Problem& b) {
        return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
    return problems;
}

std::string joined(const std::vector<Problem>& problems) {
    std::string text;
    for (const Problem& problem : problems)
        text += (text.empty() ? "" : "\n") + problem.text();
    return text;
}

/// The path of the table round a key: "solid.body[0]" of "solid.body[0].name"; "" at the root.
std::string parent(const std::string& path) {
    const std::size_t end = path.find_last_of(".[");
    return end == std::string::npos ? "" : path.substr(0, end);
}

} // namespace

CaseError::CaseError(std::vector<Problem> problems)
    : std::runtime_error(joined(in_order(problems))), problems_(in_order(std::move(problems))) {}

Place Places::find(const std::string& path) const {
    for (std::string at = path;; at = parent(at)) {
        if (const auto found = places_.find(at); found != places_.end())
            return found->second;
        if (at.empty())
            return {};
    }
}

namespace {

using google::protobuf::Message;

std::string what_is(const toml::node& node) {
    switch (node.type()) {
    case toml::node_type::table:
        return "a table";
    case toml::node_type::array:
        return "an array";
    case toml::node_type::string:
        return "a string";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
        return "a number";
    case toml::node_type::boolean:
        return node.value_or(false) ? "true" : "false";
    default:
        return "a date or time";
    }
}

/// Walks the table and the descriptors together and fills the messages.
class Reader {
  public:
    Reader(std::filesystem::path folder, Places& places, std::vector<Problem>& problems)
        : folder_(std::move(folder)), places_(places), problems_(problems) {}

    /// Everything at or below `path` came from this --set.
    void overridden(const std::string& path, const Place& place) { overrides_[path] = place; }

    void read_table(const toml::table& table, Message& message, const std::string& path);

  private:
    void read_key(const toml::node& node, Message& m, const Field& field, const std::string& path);
    void
    read_array(const toml::node& node, Message& m, const Field& field, const std::string& path);
    void read_one(const toml::node& node, Message& m, const Field& field, const std::string& path);
    void
    read_number(const toml::node& node, Message& m, const Field& field, const std::string& path);
    void
    read_whole(const toml::node& node, Message& m, const Field& field, const std::string& path);
    void read_text(const toml::node& node, Message& m, const Field& field, const std::string& path);
    void
    read_choice(const toml::node& node, Message& m, const Field& field, const std::string& path);
    void
    read_vector(const toml::node& node, Message& m, const Field& field, const std::string& path);
    void read_pair_of_functions(const toml::node& node,
                                Message& m,
                                const Field& field,
                                const std::string& path);
    void fill(const toml::node& node, v1::Function& f, const Field& field, const std::string& path);
    bool fill_table(const toml::table& table, v1::TimeTable& t, const std::string& path);
    bool has_only(const toml::table& table,
                  const std::vector<std::string>& known,
                  const std::string& path);
    void fill_absent(Message& message, const Field& field, const std::string& path);
    std::optional<std::string> existing_file(const std::string& text, const std::string& path);

    Message& submessage(Message& m, const Field& field) const {
        return field.is_repeated() ? *m.GetReflection()->AddMessage(&m, &field)
                                   : *m.GetReflection()->MutableMessage(&m, &field);
    }
    void place(const toml::source_region& region, const std::string& path);
    void problem(const std::string& path, const std::string& sentence) {
        problems_.push_back({places_.find(path), sentence});
    }
    void wrong_type(const toml::node& node, const Field& field, const std::string& path) {
        problem(path, path + " must be " + expected(field) + ", not " + what_is(node));
    }

    std::filesystem::path folder_;
    Places& places_;
    std::vector<Problem>& problems_;
    std::map<std::string, Place> overrides_;
};

std::string child(const std::string& path, const std::string& key) {
    return path.empty() ? key : path + "." + key;
}

std::string heading(const std::string& path) {
    return path.empty() ? "the case" : "[" + path + "]";
}

void Reader::place(const toml::source_region& region, const std::string& path) {
    for (std::string at = path; !at.empty(); at = parent(at))
        if (const auto found = overrides_.find(at); found != overrides_.end()) {
            places_.add(path, found->second);
            return;
        }
    // Tables made on the way, and defaults, have no place of their own.
    if (region.begin.line > 0 && region.path)
        places_.add(path, {places_.find("").source, region.begin.line, region.begin.column});
}

void Reader::read_table(const toml::table& table, Message& message, const std::string& path) {
    const Table& descriptor = *message.GetDescriptor();
    std::vector<std::string> known;
    for (int i = 0; i < descriptor.field_count(); ++i)
        known.push_back(descriptor.field(i)->name());

    for (const auto& [key, node] : table) {
        const std::string name{key.str()};
        const std::string at = child(path, name);
        place(key.source(), at);
        if (const Field* field = descriptor.FindFieldByName(name)) {
            read_key(node, message, *field, at);
            continue;
        }
        const auto near = nearest(name, known);
        problem(at,
                "unknown key '" + name + "' in " + heading(path) + "; "
                    + (near ? "nearest known key: '" + *near + "'"
                            : "known keys: " + list(known, "and")));
    }
    for (int i = 0; i < descriptor.field_count(); ++i)
        if (!table.contains(descriptor.field(i)->name()))
            fill_absent(message, *descriptor.field(i), path);
}

void Reader::fill_absent(Message& message, const Field& field, const std::string& path) {
    const v1::Key& key = key_of(field);
    const std::string at = child(path, field.name());
    if (key.required())
        problem(at,
                heading(path) + " lacks the key '" + field.name() + "', " + expected(field)
                    + (key.unit().empty() ? "" : " in " + key.unit()) + ": " + key.help());
    else if (!key.default_().empty())
        read_key(*toml::parse("value = " + key.default_()).get("value"), message, field, at);
    else if (kind_of(field) == Kind::table && !field.is_repeated()
             && always_present(*field.message_type()))
        read_table({}, submessage(message, field), at);
}

void Reader::read_key(const toml::node& node,
                      Message& m,
                      const Field& field,
                      const std::string& path) {
    if (field.is_repeated())
        read_array(node, m, field, path);
    else
        read_one(node, m, field, path);
}

void Reader::read_array(const toml::node& node,
                        Message& m,
                        const Field& field,
                        const std::string& path) {
    const toml::array* array = node.as_array();
    if (!array)
        return wrong_type(node, field, path);
    const v1::Key& key = key_of(field);
    const auto count = static_cast<int>(array->size());
    if (count < key.minimum_count())
        problem(path,
                path + " needs at least " + std::to_string(key.minimum_count()) + " entries, not "
                    + std::to_string(count));
    if (key.maximum_count() > 0 && count > key.maximum_count())
        problem(path,
                path + " takes at most " + std::to_string(key.maximum_count()) + " entries, not "
                    + std::to_string(count));
    for (std::size_t i = 0; i < array->size(); ++i) {
        const std::string at = path + "[" + std::to_string(i) + "]";
        place((*array)[i].source(), at);
        read_one((*array)[i], m, field, at);
    }
}

void Reader::read_one(const toml::node& node,
                      Message& m,
                      const Field& field,
                      const std::string& path) {
    switch (kind_of(field)) {
    case Kind::number:
        return read_number(node, m, field, path);
    case Kind::whole_number:
        return read_whole(node, m, field, path);
    case Kind::boolean:
        if (!node.is_boolean())
            return wrong_type(node, field, path);
        return m.GetReflection()->SetBool(&m, &field, node.value_or(false));
    case Kind::text:
        return read_text(node, m, field, path);
    case Kind::choice:
        return read_choice(node, m, field, path);
    case Kind::vector:
        return read_vector(node, m, field, path);
    case Kind::function:
        return fill(node, static_cast<v1::Function&>(submessage(m, field)), field, path);
    case Kind::vector_function:
        return read_pair_of_functions(node, m, field, path);
    case Kind::table:
        if (!node.is_table())
            return wrong_type(node, field, path);
        return read_table(*node.as_table(), submessage(m, field), path);
    }
}

void Reader::read_number(const toml::node& node,
                         Message& m,
                         const Field& field,
                         const std::string& path) {
    if (!node.is_number())
        return wrong_type(node, field, path);
    const double value = node.value_or(0.0);
    if (!std::isfinite(value))
        return problem(path, path + " must be a finite number");
    if (const auto broken = range_broken(field, value))
        return problem(path, path + " " + *broken);
    if (field.is_repeated())
        m.GetReflection()->AddDouble(&m, &field, value);
    else
        m.GetReflection()->SetDouble(&m, &field, value);
}

void Reader::read_whole(const toml::node& node,
                        Message& m,
                        const Field& field,
                        const std::string& path) {
    if (!node.is_integer())
        return wrong_type(node, field, path);
    const std::int64_t value = node.value_or(std::int64_t{0});
    if (value < 0 || value > std::numeric_limits<std::uint32_t>::max())
        return problem(path,
                       path + " must be a whole number between 0 and 4294967295, not "
                           + std::to_string(value));
    if (const auto broken = range_broken(field, static_cast<double>(value)))
        return problem(path, path + " " + *broken);
    m.GetReflection()->SetUInt32(&m, &field, static_cast<std::uint32_t>(value));
}

void Reader::read_text(const toml::node& node,
                       Message& m,
                       const Field& field,
                       const std::string& path) {
    if (!node.is_string())
        return wrong_type(node, field, path);
    std::string text = node.value_or(std::string{});
    if (key_of(field).file() && !text.empty()) {
        const auto found = existing_file(text, path);
        if (!found)
            return;
        text = *found;
    }
    if (field.is_repeated())
        m.GetReflection()->AddString(&m, &field, text);
    else
        m.GetReflection()->SetString(&m, &field, text);
}

std::optional<std::string> Reader::existing_file(const std::string& text, const std::string& path) {
    const std::filesystem::path file = (folder_ / text).lexically_normal();
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error))
        return file.string();
    problem(path, path + " names a file that does not exist: " + file.string());
    return std::nullopt;
}

void Reader::read_choice(const toml::node& node,
                         Message& m,
                         const Field& field,
                         const std::string& path) {
    if (!node.is_string())
        return wrong_type(node, field, path);
    const std::string text = node.value_or(std::string{});
    const std::vector<std::string> names = choices(field);
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) {
        const auto near = nearest(text, names);
        return problem(path,
                       path + " must be " + list(names) + ", not '" + text + "'"
                           + (near ? "; did you mean '" + *near + "'?" : ""));
    }
    const auto index = static_cast<int>(found - names.begin());
    m.GetReflection()->SetEnum(&m, &field, field.enum_type()->value(index));
}

void Reader::read_vector(const toml::node& node,
                         Message& m,
                         const Field& field,
                         const std::string& path) {
    const toml::array* pair = node.as_array();
    if (!pair || pair->size() != 2 || !(*pair)[0].is_number() || !(*pair)[1].is_number())
        return problem(path, path + " must be a pair of numbers [x, y]");
    const double x = (*pair)[0].value_or(0.0);
    const double y = (*pair)[1].value_or(0.0);
    if (!std::isfinite(x) || !std::isfinite(y))
        return problem(path, path + " must hold finite numbers");
    auto& vector = static_cast<v1::Vector&>(submessage(m, field));
    vector.set_x(x);
    vector.set_y(y);
}

void Reader::read_pair_of_functions(const toml::node& node,
                                    Message& m,
                                    const Field& field,
                                    const std::string& path) {
    const toml::array* pair = node.as_array();
    if (!pair || pair->size() != 2)
        return wrong_type(node, field, path);
    auto& functions = static_cast<v1::VectorFunction&>(submessage(m, field));
    fill((*pair)[0], *functions.mutable_x(), field, path + "[0]");
    fill((*pair)[1], *functions.mutable_y(), field, path + "[1]");
}

void Reader::fill(const toml::node& node,
                  v1::Function& f,
                  const Field& field,
                  const std::string& path) {
    if (node.is_string())
        f.set_formula(node.value_or(std::string{}));
    else if (node.is_table()) {
        if (!fill_table(*node.as_table(), *f.mutable_table(), path))
            return;
    } else if (node.is_number())
        f.set_number(node.value_or(0.0));
    else
        return wrong_type(node, field, path);

    std::vector<double> values(f.table().value().begin(), f.table().value().end());
    if (f.has_number())
        values.push_back(f.number());
    for (const double value : values)
        if (!std::isfinite(value))
            return problem(path, path + " must be a finite number");
        else if (const auto broken = range_broken(field, value))
            return problem(path, path + " " + *broken);
    try {
        const protocol::Function tried(f);
    } catch (const std::invalid_argument& fault) {
        problem(path, path + ": " + fault.what());
    }
}

bool Reader::has_only(const toml::table& table,
                      const std::vector<std::string>& known,
                      const std::string& path) {
    const auto bad = std::find_if(table.begin(), table.end(), [&](const auto& entry) {
        return std::find(known.begin(), known.end(), entry.first.str()) == known.end();
    });
    if (bad == table.end())
        return true;
    problem(path,
            path + " holds the unknown key '" + std::string(bad->first.str()) + "'; it takes "
                + list(known, "and"));
    return false;
}

/// { time = [..], value = [..] }, or columns of a CSV file. False if it has told a problem.
bool Reader::fill_table(const toml::table& table, v1::TimeTable& t, const std::string& path) {
    if (table.contains("file")) {
        const auto text = [&](const char* key) { return table[key].value_or(std::string{}); };
        if (!has_only(table, {"file", "along", "column"}, path))
            return false;
        if (text("column").empty()) {
            problem(path, path + " must say which column of the file it takes: column = \"angle\"");
            return false;
        }
        const auto file = existing_file(text("file"), path);
        if (!file)
            return false;
        try {
            const ReferenceTable columns(*file);
            const std::vector<double>& time = columns.column(text("along"));
            const std::vector<double>& value = columns.column(text("column"));
            t.mutable_time()->Add(time.begin(), time.end());
            t.mutable_value()->Add(value.begin(), value.end());
        } catch (const std::runtime_error& fault) {
            problem(path, path + ": " + fault.what());
            return false;
        }
        return true;
    }
    for (const auto& [key, target] :
         {std::pair{"time", t.mutable_time()}, std::pair{"value", t.mutable_value()}}) {
        const toml::array* numbers = table[key].as_array();
        for (std::size_t i = 0; numbers && i < numbers->size(); ++i)
            if ((*numbers)[i].is_number())
                target->Add((*numbers)[i].value_or(0.0));
        if (!numbers || target->size() != static_cast<int>(numbers->size())) {
            problem(path,
                    path
                        + " must hold two arrays of numbers, { time = [..], value = [..] }, or "
                          "name a file: { file = \"motion.csv\", along = \"t\", column = "
                          "\"angle\" }");
            return false;
        }
    }
    return has_only(table, {"time", "value"}, path);
}

} // namespace

Case parse_case(const std::string& text,
                const std::filesystem::path& file,
                const std::vector<std::string>& overrides) {
    Case result;
    result.file = file;
    result.folder = std::filesystem::absolute(file).lexically_normal().parent_path();
    result.name =
        file.filename() == "case.toml" ? result.folder.filename().string() : file.stem().string();
    result.places.add("", {file.string(), 1, 1});

    std::vector<Problem> problems;
    toml::table root;
    try {
        root = toml::parse(text, file.string());
    } catch (const toml::parse_error& error) {
        const auto begin = error.source().begin;
        problems.push_back({{file.string(), begin.line, begin.column},
                            "not TOML: " + std::string(error.description())});
        throw CaseError(std::move(problems));
    }
    Reader reader(result.folder, result.places, problems);
    for (const std::string& override_text : overrides) {
        const Place place{"--set " + override_text, 0, 0};
        try {
            const std::string path = apply_override(root, override_text);
            result.overridden.insert(path);
            reader.overridden(path, place);
        } catch (const std::invalid_argument& error) {
            problems.push_back({place, error.what()});
        }
    }
    reader.read_table(root, result.scene, "");
    if (!problems.empty())
        throw CaseError(std::move(problems));
    return result;
}

Case read_case(const std::filesystem::path& where, const std::vector<std::string>& overrides) {
    const bool folder = std::filesystem::is_directory(where);
    const std::filesystem::path file = folder ? where / "case.toml" : where;
    std::ifstream stream(file);
    if (!std::filesystem::is_regular_file(file) || !stream) {
        Problem problem;
        problem.place.source = file.string();
        problem.sentence = folder ? "the folder holds no readable case.toml"
                                  : "no such case: give a folder with case.toml, or a file";
        throw CaseError({problem});
    }
    std::ostringstream text;
    text << stream.rdbuf();
    return parse_case(text.str(), file, overrides);
}

} // namespace duet::orchestrator
