#include <filesystem>
#include <fstream>
#include <sstream>
#include <tuple>
#include <utility>

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "core/base/packed.hpp"
#include "core/scene/grammar/tables.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/reading/key_schema.hpp"
#include "core/scene/visit_numbers.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/files.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::schema_test {
namespace {

const std::filesystem::path problems = std::filesystem::path(source_folder()) / "problems";

nlohmann::json load(const std::filesystem::path& path) {
  std::ifstream stream(path);
  return nlohmann::json::parse(stream);
}

class ProblemSchema : public testing::Test {
 protected:
  ProblemSchema() {
    const nlohmann::json document = load(problems / "problem.schema.json");
    valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
    parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(document), schema_);
  }

  /// The complaints of the schema; empty if it is content.
  std::string complaints(const nlohmann::json& document) {
    valijson::Validator validator;
    valijson::ValidationResults results;
    if (validator.validate(schema_, valijson::adapters::NlohmannJsonAdapter(document), &results)) {
      return "";
    }
    std::string text = "not valid";
    valijson::ValidationResults::Error error;
    while (results.popError(error)) text += "\n" + error.description;
    return text;
  }

  std::string complaints_about_edit(const std::string& pointer, const std::string& value) {
    return complaints(nlohmann::json::parse(edited(pointer, value).dump()));
  }

  valijson::Schema schema_;
};

TEST_F(ProblemSchema, AcceptsEveryProblemFile) {
  int files = 0, hard_files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(problems)) {
    const std::string name = entry.path().filename().string();
    const bool is_problem = name != "problem.schema.json" && name != "catalogue.json";
    if (entry.path().extension() != ".json" || !is_problem) continue;
    EXPECT_EQ(complaints(load(entry.path())), "") << name;
    ++(entry.path().parent_path() == problems ? files : hard_files);
  }
  EXPECT_GE(files, 4);
  EXPECT_GE(hard_files, 18) << "as many as docs/stability.md lists";
}

TEST_F(ProblemSchema, RefusesKeysOfOtherJoints) {
  const Json good = good_mechanism();
  int refused = 0;
  for (const auto& [name, joint] : good.at("scene").at("joints").items()) {
    const std::string type = joint.at("type");
    const JointKind& kind = *std::ranges::find(joint_kinds, type, &JointKind::word);
    for (const JointKey& key : joint_keys) {
      if (key.is_of(kind)) continue;
      const std::string pointer = "/scene/joints/" + name + "/" + std::string(key.word);
      const Json document = edited(good, pointer, "[1, 0, 0]");
      EXPECT_NE(complaints(nlohmann::json::parse(document.dump())), "") << pointer;
      EXPECT_NE(complaint(document), "") << pointer;
      ++refused;
    }
  }
  EXPECT_GT(refused, 9);
}

TEST_F(ProblemSchema, KnowsWhatLoadCasesMayChange) {
  EXPECT_EQ(complaints_about_edit("/cases", R"({"a": {}, "b": {"/scene/gravity": [0, 0, 0]},
      "c": {"range": {"/simulation/step": {"from": "1 ms", "to": "2 ms", "count": 3}}}})"),
            "");
  EXPECT_NE(complaints_about_edit("/cases", R"({"a": {"/variables/width/start": 1}})"), "");
  EXPECT_NE(complaints_about_edit("/cases", R"({"a": {"range": {"/scene/x": {"from": 1}}}})"), "");
}

/// Every object of a document with a remark in it.
void add_comments(nlohmann::json& value) {
  for (nlohmann::json& member : value) {
    if (member.is_structured()) add_comments(member);
  }
  if (value.is_object()) value["$comment"] = "says why";
}

TEST_F(ProblemSchema, AcceptsACommentInEveryObject) {
  nlohmann::json document = nlohmann::json::parse(good_text());
  add_comments(document);
  EXPECT_EQ(complaints(document), "");
}

TEST(Comments, AreReadByNobody) {
  nlohmann::json document = nlohmann::json::parse(good_text());
  add_comments(document);
  const ProblemFile with = problem_from(document.dump());
  const ProblemFile without = problem_from(good_text());
  EXPECT_EQ(with.scene.bodies.size(), without.scene.bodies.size());
  EXPECT_EQ(with.scene.joints.size(), without.scene.joints.size());
  EXPECT_EQ(with.variables.size(), without.variables.size());
  EXPECT_EQ(with.responses.size(), without.responses.size());
  EXPECT_EQ(with.constraints.size(), without.constraints.size());
}

TEST_F(ProblemSchema, AcceptsTheGoodProblem) {
  EXPECT_EQ(complaints(nlohmann::json::parse(good_text())), "");
}

TEST_F(ProblemSchema, AcceptsFormulas) {
  for (const auto& [pointer, value] :
       {std::pair("/constants", R"({"stroke": "80 mm", "half": "= stroke/2", "ratio": 2.5})"),
        std::pair("/scene/bodies/crank/to/0", R"("= 3*width")"),
        std::pair("/simulation/end_time", R"(" = 2*50 ms")"),
        std::pair("/objective", R"({"maximize": "= place - bow"})"),
        std::pair("/constraints/effort", R"({"response": "= bow/place", "upper": "= 1/3"})"),
        std::pair("/responses/sum",
                  R"({"type": "expression", "value": "place - bow", "unit": "cm"})")}) {
    EXPECT_EQ(complaints_about_edit(pointer, value), "") << pointer;
  }
  EXPECT_NE(complaints_about_edit("/objective/maximize", R"("weight")"), "");  // minimize, too
  EXPECT_NE(complaints_about_edit("/responses/sum", R"({"type": "expression"})"), "");
}

TEST_F(ProblemSchema, AcceptsEverySectionOfTheCatalogue) {
  const nlohmann::json catalogue = load(problems / "catalogue.json");
  for (const auto& [name, section] : catalogue.at("sections").items()) {
    EXPECT_EQ(complaints_about_edit("/scene/bodies/crank/section", section.dump()), "") << name;
  }
  EXPECT_EQ(complaints_about_edit("/scene/bodies/crank/section", R"({"catalogue": "IPE 80"})"), "");
  EXPECT_EQ(complaints_about_edit("/scene/catalogue", R"("catalogue.json")"), "");
}

TEST_F(ProblemSchema, AcceptsEverySection) {
  for (
      const char* section :
      {R"({"type": "ellipse", "width": {"variable": "width"}, "height": "2 cm"})",
       R"({"type": "box", "width": {"variable": "width"}, "height": 0.02, "thickness": "1 mm"})",
       R"({"type": "i", "width": 0.02, "height": 0.04, "flange_thickness": 1e-3, "web_thickness": "1 mm"})",
       R"({"type": "general", "area": "2 cm^2", "inertia_y": 1e-8, "inertia_z": 1e-8,
            "torsion": 1e-8, "points": [{"y": 0.01, "z": 0, "shear": "1 1/cm^3"}]})",
       R"({"type": "general", "area": "2 cm^2", "inertia_y": 1e-8, "inertia_z": 1e-8,
            "torsion": 1e-8, "shear_area_y": "= 5 mm * width", "shear_area_z": "1 cm^2",
            "points": [{"y": 0.01, "z": 0, "shear": "1 1/cm^3"}]})"}) {
    EXPECT_EQ(complaints_about_edit("/scene/bodies/crank/section", section), "") << section;
    EXPECT_EQ(complaint(edited("/scene/bodies/crank/section", section)), "") << section;
  }
  for (const char* strength :
       {"strength", "ultimate_strength", "endurance_limit", "fatigue_strength"}) {
    const std::string pointer = std::string("/scene/materials/steel/") + strength;
    EXPECT_EQ(complaints_about_edit(pointer, R"("355 MPa")"), "") << strength;
    EXPECT_EQ(complaint(edited(pointer, R"("355 MPa")")), "") << strength;
  }
}

/// Of general sections with their shear areas only, which the schema cannot know of a catalogue.
TEST_F(ProblemSchema, AcceptsBeamsWithShear) {
  const std::string pointer = "/scene/bodies/crank/shear";
  for (const char* value : {"true", "false"}) {
    EXPECT_EQ(complaints_about_edit(pointer, value), "");
    EXPECT_EQ(complaint(edited(pointer, value)), "");
  }
  EXPECT_NE(complaints_about_edit(pointer, R"("yes")"), "");
  const Json general = edited("/scene/bodies/crank/section",
                              R"({"type": "general", "area": "= 5 mm * width", "inertia_y": 1e-8,
                 "inertia_z": 1e-8, "torsion": 1e-8, "points": [{"y": 0, "z": 0, "shear": 1}]})");
  EXPECT_EQ(
      complaint(edited(general, pointer, "true")),
      "bad.json: /scene/bodies/crank/shear needs \"shear_area_y\" and \"shear_area_z\" [m^2] of "
      "sections of the type \"general\", which the section has not");
}

TEST_F(ProblemSchema, AcceptsEveryReferenceOfADeflection) {
  for (const char* against : {R"("against": "frame")", R"("against": "chord", "direction": "z")",
                              R"("against": "rigid-mechanism", "direction": "x")"}) {
    const std::string bow = std::string(R"({"type": "deflection", "body": "rod", "at": 0.5,
                                            "over_time": "max", )") +
                            against + "}";
    EXPECT_EQ(complaints_about_edit("/responses/bow", bow), "") << against;
    EXPECT_EQ(complaint(edited("/responses/bow", bow)), "") << against;
  }
}

TEST_F(ProblemSchema, AcceptsFatigueShearAndBuckling) {
  Json document = edited("/scene/materials/steel/ultimate_strength", R"("470 MPa")");
  document = edited(std::move(document), "/scene/materials/steel/endurance_limit", R"("180 MPa")");
  document = edited(std::move(document), "/scene/materials/steel/fatigue_strength", R"("900 MPa")");
  document = edited(std::move(document), "/scene/materials/steel/fatigue_exponent", "9");
  for (const char* response :
       {R"({"type": "fatigue", "body": "crank", "criterion": "goodman", "from": "1 ms"})",
        R"({"type": "fatigue", "bodies": ["crank"], "criterion": "gerber"})",
        R"({"type": "fatigue-damage", "body": "crank", "at": 0.5, "criterion": "gerber"})",
        R"({"type": "shear-stress", "body": "crank", "segment": 0, "over_time": "max"})",
        R"({"type": "lateral-buckling", "body": "crank", "over_time": "rms", "to": "2 ms"})",
        R"({"type": "section-force", "body": "crank", "at": 0.5, "part": "shear-y",
            "side": "before", "over_time": "final"})"}) {
    const Json whole = edited(document, "/responses/more", response);
    EXPECT_EQ(complaints(nlohmann::json::parse(whole.dump())), "") << response;
    EXPECT_EQ(complaint(whole), "") << response;
  }
}

/// What an editor shows: not that an object is none of the kinds there are.
TEST_F(ProblemSchema, NamesTheKeyThatIsWrongInItsKind) {
  const std::pair<const char*, const char*> slips[] = {
      {"/scene/bodies/crank/elemnts", "3"},
      {"/scene/bodies/crank/section", R"({"type": "circle", "diameter": 0.01, "elemnts": 1})"},
      {"/scene/joints/again",
       R"({"type": "fixed", "bodies": ["crank", "rod"], "at": [0, 0, 0], "elemnts": 1})"},
      {"/scene/loads/push", R"({"type": "force", "body": "rod", "at": [0.3, 0, 0], "value": 1,
                                "direction": [1, 0, 0], "elemnts": 1})"},
      {"/scene/loads/push", R"({"type": "force", "body": "rod", "at": [0.3, 0, 0],
                                "direction": [1, 0, 0], "value": {"type": "constant", "value": 1, "elemnts": 1}})"},
      {"/responses/bow",
       R"({"type": "deflection", "body": "rod", "at": 0.5, "over_time": "max", "elemnts": 1})"},
      {"/responses/v", R"({"type": "velocity", "body": "rod", "direction": "x", "over_time": "max",
                           "elemnts": 1})"}};
  for (const auto& [pointer, value] : slips) {
    const std::string found = complaints_about_edit(pointer, value);
    EXPECT_NE(found.find("'elemnts'"), std::string::npos) << pointer << found;
    EXPECT_EQ(found.find("oneOf"), std::string::npos) << pointer << found;
  }
}

TEST_F(ProblemSchema, KnowsImportedBodies) {
  const auto with = [this](const std::string& keys) {
    return complaints_about_edit("/scene/bodies/rod",
                                 R"({"type": "invariants", "to": [0.3, 0, 0], )" + keys + "}");
  };
  EXPECT_EQ(with(R"("file": "rod.json", "from": ["120 mm", 0, 0])"), "");
  EXPECT_EQ(with(R"("file": "rod.json", "from": [0, 0, 0], "reference": [0, 1, 0],
                    "other_designs": "linear", "velocity": [1, 0, 0])"),
            "");
  EXPECT_NE(with(R"("from": [0, 0, 0])"), "");
  EXPECT_NE(with(R"("file": "rod.json", "from": [0, 0, 0], "other_designs": "guess")"), "");
  EXPECT_NE(with(R"("file": "rod.json", "from": [0, 0, 0], "elements": 3)"), "");
  EXPECT_EQ(complaints_about_edit("/responses/place/at", R"("wrist")"), "");
  EXPECT_EQ(complaints_about_edit("/responses/bow/at", R"("wrist")"), "");
}

TEST_F(ProblemSchema, AcceptsTheGoodMechanism) {
  EXPECT_EQ(complaints(nlohmann::json::parse(good_mechanism().dump())), "");
}

TEST_F(ProblemSchema, RefusesMechanismsThatTheReaderRefuses) {
  const std::string speed = R"({"type": "constant-speed", "speed": 1})";
  const std::vector<std::pair<std::string, std::string>> edits = {
      {"/scene/bodies/arm/frame", "\"mean\""},
      {"/scene/bodies/arm/reduction", "{}"},
      {"/scene/bodies/arm/reduction", "remove"},
      {"/scene/bodies/arm/reduction/frequency", "100"},
      {"/scene/bodies/arm/reduction/modes", "-1"},
      {"/scene/bodies/arm/damping/mass", "1"},
      {"/scene/bodies/strut/rigid", "1"},
      {"/scene/bodies/strut/damping", "{}"},
      {"/scene/bodies/ball/angular_velocity", "[0, 0, 1]"},
      {"/scene/bodies/block/velocity", "[0, 0]"},
      {"/scene/joints/shoulder/axis", "remove"},
      {"/scene/joints/shoulder/drive/coordinate", "remove"},
      {"/scene/joints/elbow/second_axis", "remove"},
      {"/scene/joints/floor/second_axis", "[1, 0, 0]"},
      {"/scene/joints/wrist/axis", "[1, 0, 0]"},
      {"/scene/joints/wrist/drive", speed},
      {"/scene/joints/wrist/to", "[1, 0, 0]"},
      {"/scene/joints/tie/to", "remove"},
      {"/scene/joints/tie/drive/times", "[0]"},
      {"/scene/joints/line/drive/sped", "1"},
      {"/scene/joints/shoulder/drive/coefficients", "[]"},
      {"/scene/joints/elbow/drive/frequency", "remove"},
      {"/scene/loads/push/type", "\"weight\""},
      {"/scene/loads/push/value", speed},
      {"/scene/loads/push/value", R"({"type": "constant", "value": 1, "coordinate": "angle"})"},
      {"/scene/loads/push/follows", "1"},
      {"/scene/loads/strap/at", "[[4, 0, 0]]"},
      {"/scene/loads/strap/stiffness", "remove"},
      {"/scene/loads/strap/bodies", R"(["ground", "ground"])"},
      {"/scene/loads/hinge/damping", "remove"},
      {"/scene/loads/hinge/rest", "0.1"},
      {"/effects/tolerance", "1"},
      {"/effects/elasticity", "true"},
      {"/simulation/initial_state", "\"static\""},
      {"/responses/speed/direction", "\"norm\""},
      {"/responses/speed/type", "\"position\""},
      {"/responses/tone/mode", "0"},
      {"/responses/tone/over_time", "\"max\""},
      {"/responses/shear/at", "0.5"},
      {"/responses/axial/part", "\"tension\""},
      {"/responses/bearing/direction", "remove"},
      {"/responses/motion/over_time", "remove"},
      {"/responses/missing/over_time", "\"max\""},
      {"/responses/drift/level", "\"speed\""},
      {"/responses/drift/body", "\"arm\""}};
  for (const auto& [pointer, value] : edits) {
    const Json document = edited(good_mechanism(), pointer, value);
    EXPECT_NE(complaints(nlohmann::json::parse(document.dump())), "") << pointer << " = " << value;
    EXPECT_NE(complaint(document), "") << pointer << " = " << value;
  }
}

TEST_F(ProblemSchema, RefusesWhatTheReaderRefuses) {
  const std::vector<std::pair<std::string, std::string>> edits = {
      {"/scene", "remove"},
      {"/simulation/step", "remove"},
      {"/colour", "1"},
      {"/scene/bodies/ground", R"({"type": "point-mass", "at": [0, 0, 0], "mass": 1})"},
      {"/scene/bodies/crank/section/diamter", "1"},
      {"/scene/bodies/crank/section/type", "\"hexagon\""},
      {"/scene/bodies/crank/section/width", "true"},
      {"/scene/bodies/crank/section", R"({"type": "ellipse", "width": 0.01})"},
      {"/scene/bodies/crank/section", R"({"type": "box", "width": 0.01, "height": 0.01})"},
      {"/scene/bodies/crank/section", R"({"catalogue": "IPE 80", "width": 0.01})"},
      {"/scene/bodies/crank/section", R"({"catalogue": 80})"},
      {"/scene/bodies/crank/section",
       R"({"type": "i", "width": 0.02, "height": 0.04, "flange_thickness": 1e-3})"},
      {"/scene/bodies/crank/section",
       R"({"type": "general", "area": 1e-4, "inertia_y": 1e-8, "inertia_z": 1e-8, "torsion": 1e-8, "points": []})"},
      {"/scene/bodies/crank/section",
       R"({"type": "general", "area": 1e-4, "inertia_y": 1e-8, "inertia_z": 1e-8,
           "torsion": 1e-8, "points": [{"y": 0, "z": 0}]})"},
      {"/scene/catalogue", "7"},
      {"/scene/materials/steel/strength", "true"},
      {"/scene/bodies/crank/section/width", R"({"variable": "width", "factor": 0})"},
      {"/scene/bodies/crank/segments", "[]"},
      {"/scene/bodies/crank/elements", "0"},
      {"/scene/bodies/crank/elements", "2.5"},
      {"/scene/bodies/crank/from", "[0, 0]"},
      {"/scene/bodies/wheel/inertia", "[1, 1, 1]"},
      {"/scene/joints/bearing/drive/type", "\"motor\""},
      {"/scene/joints/guide/axis", "remove"},
      {"/scene/joints/hub/drive", R"({"type": "constant-speed", "speed": 1})"},
      {"/scene/joints/hub/axis", "[0, 0, 1]"},
      {"/effects/torsion", "\"on\""},
      {"/effects/spatial_motion", "true"},
      {"/simulation/scheme", "\"euler\""},
      {"/simulation/spectral_radius", "1.5"},
      {"/variables/width/lower", "remove"},
      {"/variables/width/start", "\"thick\""},
      {"/responses/weight/over_time", "\"max\""},
      {"/responses/stress/over_time", "remove"},
      {"/responses/bow/at", "1.5"},
      {"/responses/bow/direction", "\"w\""},
      {"/responses/bow/against", "\"cord\""},
      {"/constraints/strength/upper", "remove"},
      {"/constraints/slender/response", "\"bow\""},
      {"/constraints/strength/deviations", "0"},
      {"/sensitivity/method", "\"central\""},
      {"/sensitivity/step", "1e-5"},
      {"/sensitivity/invariant_derivatives", "\"dual\""},
      {"/sensitivity/memory", "\"much\""},
      {"/optimizer/tolerance", "0"},
      {"/pareto/points", "1"},
      {"/pareto/gap", "0"},
      {"/pareto/most_points", "9"},
      {"/accuracy/steps", "[]"}};
  for (const auto& [pointer, value] : edits) {
    EXPECT_NE(complaints_about_edit(pointer, value), "") << pointer << " = " << value;
    EXPECT_NE(complaint(edited(pointer, value)), "") << pointer << " = " << value;
  }
}

// The tables of keys, and what follows from them.

std::string schema_file() {
  std::ifstream stream(source_folder() + "/problems/problem.schema.json");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(Grammar, SchemaIsThatOfTheTables) {
  const std::string text = schema_file();
  EXPECT_EQ(schema_text(with_tables(Json::parse(text))), text)
      << "build the target problem_schema, and run it as docs/architecture.md says";
}

TEST(Grammar, EveryKeyOfTheSchemaHasASentenceOrADefinition) {
  const Json schema = with_tables(Json::parse(schema_file()));
  for (const char* name : {"material", "simulation", "sensitivity", "effects", "damping"}) {
    for (const auto& [key, property] : schema["definitions"][name]["properties"].items()) {
      EXPECT_TRUE(property.contains("description") || property.contains("$ref"))
          << name << " " << key;
    }
  }
}

/// Counts the numbers that a table names.
class NumberCount : public Keys {
 public:
  void number(const Key&, KeyMember<Number>, const Measure&, std::string_view) override { ++count; }
  void fixed(const Key&, KeyMember<Number>, const Measure&, std::string_view) override { ++count; }

  std::size_t count = 0;
};

template <class Member>
inline constexpr bool is_number =
    std::is_same_v<Member, Number> || std::is_same_v<Member, std::optional<Number>>;

/// A number that is left out of its table would have no derivatives.
template <class Struct, class... Measures>
void expect_all_numbers(const char* name, const Measures&... measures) {
  Struct object;
  const std::size_t there = with_members(object, [](const auto&... members) {
    return (0U + ... + is_number<std::decay_t<decltype(members)>>);
  });
  NumberCount numbers;
  describe(numbers, object, measures...);
  EXPECT_EQ(numbers.count, there) << name;
  EXPECT_GT(there, 0U) << name;
}

TEST(Grammar, TablesHaveAllNumbersOfTheirStructs) {
  expect_all_numbers<RectangleSection>("rectangle");
  expect_all_numbers<CircleSection>("circle");
  expect_all_numbers<TubeSection>("tube");
  expect_all_numbers<EllipseSection>("ellipse");
  expect_all_numbers<BoxSection>("box");
  expect_all_numbers<ISection>("i");
  expect_all_numbers<GeneralSection>("general");
  expect_all_numbers<GeneralStressPoint>("point");
  expect_all_numbers<Material>("material");
  expect_all_numbers<Damping>("damping");
  expect_all_numbers<RigidBody>("rigid");
  expect_all_numbers<PointMass>("point mass");
  expect_all_numbers<InitialDeflection>("initial deflection");
  expect_all_numbers<SpringDamper>("spring");
  const AlongCoordinate measures = along(DrivenCoordinate::angle);
  expect_all_numbers<JointForce>("joint", measures);
  expect_all_numbers<MotorControl>("control", measures);
  expect_all_numbers<FrictionLaw>("friction", measures);
  expect_all_numbers<ClearanceLaw>("clearance", measures);
  const Quantity angle = quantities::angle;
  expect_all_numbers<ConstantFunction>("constant", angle);
  expect_all_numbers<ConstantSpeedDrive>("constant speed", angle);
  expect_all_numbers<RampToSpeedDrive>("ramp to speed", angle);
  expect_all_numbers<HarmonicFunction>("harmonic", angle);
  expect_all_numbers<RampFunction>("ramp", angle);
  expect_all_numbers<HalfSineFunction>("half sine", angle);
}

/// The numbers that are visited.
template <class Visited>
std::vector<double> visited_numbers(const Visited& visited) {
  std::vector<double> numbers;
  visit_numbers(visited, [&](const Number& number) { numbers.push_back(number.constant); });
  return numbers;
}

TEST(Grammar, VisitsLeaveOutWhatIsNotGiven) {
  GeneralSection section{1.0, 2.0, 3.0, 4.0, {{5.0, 6.0, 7.0}}};
  EXPECT_EQ(visited_numbers(Section(section)), (std::vector<double>{1, 2, 3, 4, 5, 6, 7}));
  section.shear_area_y = 8.0;
  section.shear_area_z = 9.0;
  EXPECT_EQ(visited_numbers(Section(section)).size(), 9U);
  Material material{"steel", 1.0, 2.0, 3.0};
  EXPECT_EQ(visited_numbers(material), (std::vector<double>{1, 2, 3}));
  material.fatigue_strength = 4.0;
  EXPECT_EQ(visited_numbers(material), (std::vector<double>{1, 2, 3, 4}));
}

}  // namespace
}  // namespace pleuel::test::schema_test
