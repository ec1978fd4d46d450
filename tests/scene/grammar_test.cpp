#include <fstream>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/members.hpp"
#include "core/scene/grammar/tables.hpp"
#include "core/scene/reading/key_schema.hpp"
#include "core/scene/visit_numbers.hpp"
#include "tests/support/source_folder.hpp"

/// The tables of keys, and what follows from them.
namespace pleuel::test::grammar_test {
namespace {

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
  void number(const Key&, Number&, const Measure&, std::string_view) override { ++count; }
  void fixed(const Key&, Number&, const Measure&, std::string_view) override { ++count; }
  bool gives(const Key&, bool) override { return true; }

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

/// The numbers that are visited, by what they measure.
template <class Visited>
std::vector<std::string> visited_units(const Visited& visited) {
  std::vector<std::string> units;
  visit_numbers(visited, [&units](const Number&, const Quantity& quantity) {
    units.emplace_back(quantity.unit);
  });
  return units;
}

TEST(Grammar, VisitsLeaveOutWhatIsNotGiven) {
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
}  // namespace pleuel::test::grammar_test
