// The case file: what it says reaches the scene, what is wrong is said with its place and a remedy.

#include "orchestrator/case_file.hpp"
#include "orchestrator/schema.hpp"

#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>

namespace duet::orchestrator {
namespace {

using google::protobuf::Message;
using google::protobuf::util::MessageDifferencer;

const std::string small = R"(title = "small"
[time]
end = 1

[fluid]
spacing = 0.1
region = [[0, 0], [1, 0], [1, 1], [0, 1]]
density = 2
kinematic_viscosity = 0.5
)";

Case parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parse_case(text, "case.toml", overrides);
}

/// The problems of a case, as text.
std::string problems(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
        parse(text, overrides);
    } catch (const CaseError& error) {
        return error.what();
    }
    return "";
}

TEST(CaseFile, ValuesAndDefaultsReachTheScene) {
    const v1::Scene scene = parse(small).scene;
    EXPECT_EQ(scene.title(), "small");
    EXPECT_EQ(scene.fluid().density(), 2);
    ASSERT_EQ(scene.fluid().region_size(), 4);
    EXPECT_EQ(scene.fluid().region(2).x(), 1);
    EXPECT_EQ(scene.fluid().seed(), 1u);
    EXPECT_TRUE(scene.fluid().has_sound_speed());
    EXPECT_EQ(scene.fluid().pressure_level(), v1::Fluid::ZERO_MEAN);
    EXPECT_TRUE(scene.has_gravity());
    EXPECT_TRUE(scene.coupling().has_schedule());
    EXPECT_EQ(scene.coupling().balance_tolerance(), 1e-12);
    EXPECT_FALSE(scene.has_solid()) << "a table with required keys stays absent";
    EXPECT_FALSE(scene.fluid().wall_size());
}

TEST(CaseFile, AFunctionIsANumberAFormulaOrATable) {
    const auto start = [](const std::string& value) {
        return parse(small + "initial_temperature = " + value + "\n")
            .scene.fluid()
            .initial_temperature();
    };
    EXPECT_EQ(parse(small).scene.fluid().initial_temperature().number(), 0);
    EXPECT_EQ(start("300").number(), 300);
    EXPECT_EQ(start("\"300 + 2*x\"").formula(), "300 + 2*x");
    EXPECT_EQ(start("{ time = [0, 2.5], value = [1, 7] }").table().value(1), 7);
    EXPECT_EQ(start("{ time = [0, 2.5], value = [1, 7] }").table().time(1), 2.5);
}

TEST(CaseFile, AFunctionThatCannotBeReadIsSaid) {
    const auto with = [](const std::string& value) {
        return problems(small + "initial_temperature = " + value + "\n");
    };
    EXPECT_NE(with("\"300 + z\"")
                  .find("case.toml:10:1: fluid.initial_temperature: the formula "
                        "'300 + z' cannot be read: "),
              std::string::npos);
    EXPECT_NE(with("{ time = [1, 0], value = [1, 2] }").find("must rise"), std::string::npos);
    EXPECT_NE(with("{ time = [0, 1], value = [1] }").find("as many values"), std::string::npos);
    EXPECT_NE(with("{ times = [0, 1] }").find("two arrays of numbers"), std::string::npos);
    EXPECT_NE(with("{ file = \"no.csv\", column = \"T\" }").find("does not exist"),
              std::string::npos);
    EXPECT_NE(with("{ file = \"no.csv\" }").find("which column"), std::string::npos);
    EXPECT_NE(with("{ file = \"no.csv\", colum = \"T\" }").find("unknown key 'colum'"),
              std::string::npos);
    EXPECT_NE(with("{ time = [0], value = [1], foo = 1 }").find("unknown key 'foo'"),
              std::string::npos);
    EXPECT_NE(with("inf").find("finite"), std::string::npos);
    EXPECT_NE(with("true").find("must be a number, a formula"), std::string::npos);
}

TEST(CaseFile, UnknownKeyIsSaidWithItsPlaceAndTheNearest) {
    EXPECT_EQ(problems(small + "viscosity = 1\n"),
              "case.toml:10:1: unknown key 'viscosity' in [fluid]; nearest known key: "
              "'kinematic_viscosity'");
    EXPECT_NE(problems("titel = 'x'\n" + small).find("nearest known key: 'title'"),
              std::string::npos);
    EXPECT_NE(problems("zzzzzzzz = 1\n" + small).find("known keys: title, time, gravity"),
              std::string::npos);
}

TEST(CaseFile, EachKindOfFaultHasItsSentence) {
    const auto with = [](const std::string& lines) { return problems(small + lines); };
    EXPECT_EQ(with("conductivity = \"a\"\n"),
              "case.toml:10:1: fluid.conductivity must be a number, not a string");
    EXPECT_EQ(with("conductivity = -1\n"),
              "case.toml:10:1: fluid.conductivity must be at least 0, not -1");
    EXPECT_EQ(with("disorder = 0.5\n"),
              "case.toml:10:1: fluid.disorder must be at least 0 and at most 0.4, not 0.5");
    EXPECT_EQ(with("conductivity = nan\n"),
              "case.toml:10:1: fluid.conductivity must be a finite number");
    EXPECT_EQ(with("seed = 1.5\n"),
              "case.toml:10:1: fluid.seed must be a whole number, 0 or greater, not a number");
    EXPECT_EQ(with("seed = -1\n"),
              "case.toml:10:1: fluid.seed must be a whole number between 0 and 4294967295, not -1");
    EXPECT_EQ(
        with("initial_velocity = [1]\n"),
        "case.toml:10:1: fluid.initial_velocity must be a pair [x, y] of numbers, formulas or "
        "tables in time, not an array");
    EXPECT_EQ(
        with("pressure_level = \"zero_means\"\n"),
        "case.toml:10:1: fluid.pressure_level must be zero_mean or free, not 'zero_means'; did "
        "you mean 'zero_mean'?");
    EXPECT_EQ(with("wall = 3\n"),
              "case.toml:10:1: fluid.wall must be an array of tables, not a number");
    EXPECT_EQ(with("[output]\ncoupling = 1\n"),
              "case.toml:11:1: output.coupling must be true or false, not a number");
    EXPECT_NE(with("[[check]]\nquantity = 'x'\ntolerance = 1\nreference = 'no/such.csv'\n")
                  .find("case.toml:13:1: check[0].reference names a file that does not exist: /"),
              std::string::npos);
    EXPECT_NE(with("[[fluid.wall]]\nname = 'w'\nalong = [[0, 0]]\n")
                  .find("fluid.wall[0].along needs at least 2 entries, not 1"),
              std::string::npos);
    EXPECT_NE(with("[[fluid.wall]]\nname = 'w'\nalong = [[0, 0], [1, 1], [2, 2]]\n")
                  .find("fluid.wall[0].along takes at most 2 entries, not 3"),
              std::string::npos);
    EXPECT_NE(with("[[fluid.wall]]\nname = 'w'\nalong = [[0, 0], [1, 'a']]\n")
                  .find("case.toml:12:18: fluid.wall[0].along[1] must be a pair"),
              std::string::npos);
}

TEST(CaseFile, MissingKeysAreNamedWithUnitAndHelp) {
    EXPECT_EQ(problems("[time]\n"),
              "case.toml:1:2: [time] lacks the key 'end', a number in s: Simulated time at which "
              "the run ends.");
    EXPECT_NE(problems("title = ''\n").find("the case lacks the key 'time', a table"),
              std::string::npos);
}

TEST(CaseFile, AllFaultsAreReportedInTheOrderOfTheFile) {
    const std::string text = problems("[time]\nend = 0\nx = 1\n[fluid]\nspacing = 'a'\n");
    const std::vector<std::string> order = {
        ":2:1: time.end", ":3:1: unknown", ":4:2: [fluid] lacks", ":5:1: fluid.spacing"};
    std::size_t at = 0;
    for (const std::string& part : order) {
        const std::size_t found = text.find(part);
        ASSERT_NE(found, std::string::npos) << part << " in\n" << text;
        EXPECT_GE(found, at) << part;
        at = found;
    }
}

TEST(CaseFile, NotTomlIsSaidWithItsPlace) {
    EXPECT_EQ(problems("[time]\nend = = 2\n").rfind("case.toml:2:7: not TOML: ", 0), 0u);
}

TEST(CaseFile, MissingCaseIsSaid) {
    EXPECT_THROW(read_case("/no/such/case"), CaseError);
    try {
        read_case(DUET_SOURCE_DIR "/orchestrator");
        FAIL();
    } catch (const CaseError& error) {
        EXPECT_NE(std::string(error.what()).find("holds no readable case.toml"), std::string::npos);
    }
}

TEST(Overrides, ReplaceValuesMakeTablesAndAppend) {
    const v1::Scene scene = parse(small,
                                  {"fluid.density=7",
                                   "output.interval=0.5",
                                   "fluid.region[2][0]=3",
                                   "coupling.schedule=\"parallel\"",
                                   "probe[0].name=\"p\"",
                                   "probe[0].of=\"fluid\"",
                                   "probe[0].quantity=\"q\"",
                                   "probe[0].at=[0.5, 0.25]"})
                                .scene;
    EXPECT_EQ(scene.fluid().density(), 7);
    EXPECT_EQ(scene.output().interval(), 0.5);
    EXPECT_EQ(scene.fluid().region(2).x(), 3);
    EXPECT_EQ(scene.coupling().schedule(), v1::Coupling::PARALLEL);
    ASSERT_EQ(scene.probe_size(), 1);
    EXPECT_EQ(scene.probe(0).at().y(), 0.25);
}

TEST(Overrides, FaultsNameTheSet) {
    const auto fault = [](const std::string& text) { return problems(small, {text}); };
    EXPECT_EQ(fault("fluid.density=-1"),
              "--set fluid.density=-1: fluid.density must be greater than 0, not -1");
    EXPECT_EQ(
        fault("fluid.densty=1"),
        "--set fluid.densty=1: unknown key 'densty' in [fluid]; nearest known key: 'density'");
    EXPECT_NE(fault("fluid.density").find("expected KEY=VALUE"), std::string::npos);
    EXPECT_NE(fault("fluid..density=1").find("cannot read the key"), std::string::npos);
    EXPECT_NE(fault("fluid.density=one").find("must be a number, not a string"), std::string::npos);
    EXPECT_NE(fault("title=one two").find("a string needs double quotes"), std::string::npos);
    EXPECT_EQ(parse(small, {"coupling.schedule=parallel"}).scene.coupling().schedule(),
              v1::Coupling::PARALLEL);
    EXPECT_NE(fault("probe[2].name=\"x\"").find("there is no entry [2]"), std::string::npos);
    EXPECT_NE(fault("fluid.density.x=1").find("no table that could hold 'x'"), std::string::npos);
    EXPECT_NE(fault("fluid.density=1\nend = 2").find("is not TOML"), std::string::npos);
}

TEST(Schema, EveryDefaultIsOfItsTypeAndInItsRange) {
    const auto visit = [](const Table& table, const auto& self) -> void {
        for (int i = 0; i < table.field_count(); ++i) {
            const Field& field = *table.field(i);
            EXPECT_FALSE(key_of(field).help().empty()) << field.full_name();
            EXPECT_FALSE(key_of(field).required() && !key_of(field).default_().empty())
                << field.full_name();
            if (kind_of(field) == Kind::table)
                self(*field.message_type(), self);
        }
    };
    visit(*v1::Scene::descriptor(), visit);
    // Defaults are read as if they were written; a bad one would be a problem of this case.
    EXPECT_EQ(problems(small + R"(
[[fluid.wall]]
name = "w"
along = [[0, 0], [1, 0]]
[[solid.body]]
name = "b"
rectangle = { corner = [0, 0], width = 1, height = 1 }
element_size = 1
density = 1
[[solid.body.boundary]]
name = "s"
along = [[0, 0], [1, 0]]
convection = { coefficient = 1, temperature = 2 }
[[probe]]
name = "p"
of = "fluid"
quantity = "q"
[[check]]
quantity = "p"
tolerance = 1
)"),
              "");
}

TEST(Schema, NearestKeyIsTheOneMeant) {
    const std::vector<std::string> names = {"density", "conductivity", "kinematic_viscosity"};
    EXPECT_EQ(nearest("denisty", names), "density");
    EXPECT_EQ(nearest("viscosity", names), "kinematic_viscosity");
    EXPECT_EQ(nearest("conductivty", names), "conductivity");
    EXPECT_EQ(nearest("colour", names), std::nullopt);
}

// ------------------------------------------------------------------------------- writing it back

void random_function(v1::Function& function, std::mt19937& random, double number) {
    switch (random() % 3) {
    case 0:
        return function.set_number(number);
    case 1:
        return function.set_formula("2*x^2 + t/" + number_text(number));
    default:
        for (int i = 0; i < 3; ++i) {
            function.mutable_table()->add_time(i * number);
            function.mutable_table()->add_value(number / (i + 1));
        }
    }
}

/// Fills every field of a message with random values of its kind.
void randomise(Message& m, std::mt19937& random) {
    const auto number = [&] {
        return std::ldexp(static_cast<double>(random()) / 7.0,
                          static_cast<int>(random() % 60) - 40);
    };
    const auto& r = *m.GetReflection();
    for (int i = 0; i < m.GetDescriptor()->field_count(); ++i) {
        const Field& field = *m.GetDescriptor()->field(i);
        const v1::Key& key = key_of(field);
        // Numbers with a range lie within it, and above 1e-13 if they must be positive.
        const double value = key.has_below() || key.has_maximum()     ? 0.3
                             : key.has_minimum() && key.minimum() > 1 ? 5
                                                                      : number();
        const int count =
            field.is_repeated()
                ? std::max(1, key.minimum_count())
                      + (key.maximum_count() == 0 ? static_cast<int>(random() % 3) : 0)
                : 1;
        for (int j = 0; j < count; ++j)
            switch (kind_of(field)) {
            case Kind::number:
                field.is_repeated() ? r.AddDouble(&m, &field, value)
                                    : r.SetDouble(&m, &field, value);
                break;
            case Kind::whole_number:
                r.SetUInt32(&m, &field, static_cast<std::uint32_t>(random() % 65536 | 2U));
                break;
            case Kind::boolean:
                r.SetBool(&m, &field, random() % 2 == 0);
                break;
            case Kind::text: {
                const std::string text = key.file()
                                             ? DUET_SOURCE_DIR "/CMakeLists.txt"
                                             : "a \"b\" \\ \n\t é" + std::to_string(random());
                field.is_repeated() ? r.AddString(&m, &field, text) : r.SetString(&m, &field, text);
                break;
            }
            case Kind::choice:
                r.SetEnumValue(
                    &m,
                    &field,
                    static_cast<int>(random()
                                     % static_cast<unsigned>(field.enum_type()->value_count())));
                break;
            case Kind::vector: {
                Message& vector =
                    field.is_repeated() ? *r.AddMessage(&m, &field) : *r.MutableMessage(&m, &field);
                static_cast<v1::Vector&>(vector).set_x(-number());
                static_cast<v1::Vector&>(vector).set_y(number());
                break;
            }
            case Kind::function:
                random_function(
                    static_cast<v1::Function&>(*r.MutableMessage(&m, &field)), random, value);
                break;
            case Kind::vector_function: {
                auto& pair = static_cast<v1::VectorFunction&>(*r.MutableMessage(&m, &field));
                random_function(*pair.mutable_x(), random, value);
                random_function(*pair.mutable_y(), random, value);
                break;
            }
            case Kind::table:
                randomise(field.is_repeated() ? *r.AddMessage(&m, &field)
                                              : *r.MutableMessage(&m, &field),
                          random);
                break;
            }
    }
}

TEST(WriteCase, ReadingItBackGivesAnEqualScene) {
    std::mt19937 random(1);
    for (int i = 0; i < 50; ++i) {
        v1::Scene scene;
        randomise(scene, random);
        const std::string text = write_case(scene);
        const v1::Scene again = parse(text).scene;
        std::string difference;
        MessageDifferencer differencer;
        differencer.ReportDifferencesToString(&difference);
        ASSERT_TRUE(differencer.Compare(scene, again)) << difference << text;
    }
}

TEST(WriteCase, ShippedCasesRoundTrip) {
    for (const char* name : {"hot_plate", "two_layers"}) {
        const Case given = read_case(std::string(DUET_SOURCE_DIR "/cases/") + name);
        EXPECT_EQ(given.name, name);
        EXPECT_TRUE(MessageDifferencer::Equals(given.scene, parse(write_case(given.scene)).scene));
    }
}

TEST(Reference, DocsAreCurrent) {
    std::ifstream stream(DUET_SOURCE_DIR "/docs/case-file.md");
    std::ostringstream text;
    text << stream.rdbuf();
    EXPECT_EQ(text.str(), case_file_reference())
        << "write it anew: build/release/bin/duet reference > docs/case-file.md";
}

} // namespace
} // namespace duet::orchestrator
