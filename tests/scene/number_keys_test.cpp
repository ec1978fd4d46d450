#include "core/scene/number_keys.hpp"

#include <fstream>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/scene/visit_numbers.hpp"
#include "tests/support/source_folder.hpp"

/// The schema, which is written by hand, says of every number what the tables of keys say.
namespace pleuel::test::number_keys_test {
namespace {

using nlohmann::json;

const json& definitions() {
  static const json all = [] {
    std::ifstream stream(source_folder() + "/problems/problem.schema.json");
    return json::parse(stream).at("definitions");
  }();
  return all;
}

/// The part of a definition that is for one of its types.
const json& branch(const std::string& definition, const std::string& type) {
  for (const json& one : definitions().at(definition).at("allOf")) {
    const json condition = one.at("if").value("properties", json::object());
    if (condition.contains("type") && condition["type"].value("const", "") == type) {
      return one.at("then");
    }
  }
  throw std::runtime_error(definition + " has no type " + type);
}

bool is_required(const json& object, std::string_view word) {
  for (const json& one : object.value("required", json::array())) {
    if (one == word) return true;
  }
  return false;
}

std::string rule_word(Range range) {
  if (range == Range::positive) return "positive";
  return range == Range::not_negative ? "not negative" : "";
}

/// @param must_describe  whether the schema has to say unit and rule: it leaves out what goes
///   without saying (a size is positive), and the unit of a function's own value
template <class Struct, std::size_t count>
void expect_in_schema(const json& object, const std::array<NumberKey<Struct>, count>& keys,
                      bool must_describe = true) {
  for (const NumberKey<Struct>& key : keys) {
    SCOPED_TRACE(key.word);
    const auto found = object.at("properties").find(std::string(key.word));
    ASSERT_NE(found, object.at("properties").end());
    const std::string reference = found->at("$ref");
    EXPECT_TRUE(reference == "#/definitions/designable" || reference == "#/definitions/quantity");
    EXPECT_EQ(is_required(object, key.word), key.presence == Presence::required);
    if (!must_describe) continue;
    const std::string text = found->value("description", "");
    if (key.quantity.unit != "1") {
      EXPECT_NE(text.find("[" + std::string(key.quantity.unit) + "]"), std::string::npos) << text;
    }
    EXPECT_NE(text.find(rule_word(key.range)), std::string::npos) << text;
  }
}

template <class Struct>
void expect_section(const std::string& type) {
  SCOPED_TRACE(type);
  const json& object = branch("section", type);
  const auto keys = number_keys(KeysOf<Struct>());
  expect_in_schema(object, keys, false);
  for (const auto& key : keys) {
    const std::string text = object["properties"][std::string(key.word)].value("description", "");
    EXPECT_NE(text.find("[" + std::string(key.quantity.unit) + "]"), std::string::npos) << text;
  }
}

TEST(NumberKeys, OfSectionsAreThoseOfTheSchema) {
  expect_section<RectangleSection>("rectangle");
  expect_section<CircleSection>("circle");
  expect_section<TubeSection>("tube");
  expect_section<EllipseSection>("ellipse");
  expect_section<BoxSection>("box");
  expect_section<ISection>("i");
  expect_section<GeneralSection>("general");
  expect_in_schema(branch("section", "general").at("properties").at("points").at("items"),
                   number_keys(KeysOf<GeneralStressPoint>()), false);
}

TEST(NumberKeys, OfBodiesAreThoseOfTheSchema) {
  expect_in_schema(definitions().at("material"), number_keys(KeysOf<Material>()));
  expect_in_schema(definitions().at("damping"), number_keys(KeysOf<Damping>()));
  expect_in_schema(definitions().at("rigid"), number_keys(KeysOf<RigidBody>()));
  expect_in_schema(definitions().at("point_mass"), number_keys(KeysOf<PointMass>()));
  expect_in_schema(definitions().at("initial_deflections").at("items"),
                   number_keys(KeysOf<InitialDeflection>()));
}

TEST(NumberKeys, OfForceElementsAreThoseOfTheSchema) {
  expect_in_schema(branch("load", "spring"), number_keys(KeysOf<SpringDamper>()));
  for (const DrivenCoordinate coordinate :
       {DrivenCoordinate::angle, DrivenCoordinate::displacement}) {
    const AlongCoordinate measures = along(coordinate);
    expect_in_schema(branch("load", "joint"), number_keys(KeysOf<JointForce>(), measures));
    expect_in_schema(definitions().at("control"), number_keys(KeysOf<MotorControl>(), measures));
    expect_in_schema(definitions().at("friction"),
                     number_keys(KeysOf<FrictionLaw>(), measures.force));
    expect_in_schema(definitions().at("clearance"),
                     number_keys(KeysOf<ClearanceLaw>(), measures.force));
  }
}

TEST(NumberKeys, OfFunctionsOfTimeAreThoseOfTheSchema) {
  const Quantity angle = quantities::angle;
  expect_in_schema(definitions().at("constant"), number_keys(KeysOf<ConstantFunction>(), angle),
                   false);
  expect_in_schema(branch("drive", "constant-speed"),
                   number_keys(KeysOf<ConstantSpeedDrive>(), angle));
  expect_in_schema(branch("drive", "ramp-to-speed"), number_keys(KeysOf<RampToSpeedDrive>(), angle),
                   false);
  expect_in_schema(definitions().at("harmonic"), number_keys(KeysOf<HarmonicFunction>(), angle),
                   false);
  expect_in_schema(definitions().at("ramp"), number_keys(KeysOf<RampFunction>(), angle), false);
  expect_in_schema(definitions().at("half_sine"), number_keys(KeysOf<HalfSineFunction>(), angle),
                   false);
}

/// The numbers that are visited, by what they measure.
template <class Visited>
std::vector<std::string> visited_units(const Visited& visited) {
  std::vector<std::string> units;
  visit_numbers(visited, [&units](const Number&, const Quantity& quantity) {
    units.emplace_back(quantity.unit);
  });
  return units;
}

TEST(NumberKeys, LeaveOutWhatIsNotGiven) {
  GeneralSection section;
  section.points.resize(1);
  const std::vector<std::string> without = {"m^2", "m^4", "m^4", "m^4", "m", "m", "1/m^3"};
  EXPECT_EQ(visited_units(Section(section)), without);
  section.shear_area_y = 1.0;
  section.shear_area_z = 2.0;
  EXPECT_EQ(visited_units(Section(section)).size(), without.size() + 2);
  Material material;
  EXPECT_EQ(visited_units(material), (std::vector<std::string>{"Pa", "1", "kg/m^3"}));
  material.fatigue_strength = 1e9;
  EXPECT_EQ(visited_units(material).back(), "Pa");
  EXPECT_EQ(visited_units(material).size(), 4U);
}

}  // namespace
}  // namespace pleuel::test::number_keys_test
