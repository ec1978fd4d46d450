#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "core/base/value_path.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/support/source_folder.hpp"

/// Sizes and sections that are chosen from lists.
namespace pleuel::test::choices_test {
namespace {

using Json = nlohmann::ordered_json;

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string file = source_folder() + "/problems/any.json";

/// A beam with a section, and a variable.
Json beam_document(const std::string& section, const std::string& variable) {
  return Json::parse(R"({"scene": {"catalogue": "catalogue.json", "bodies": {"beam": {
    "type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel", "elements": 1,
    "section": )" + section +
                     R"(}}, "joints": {"wall": {"type": "fixed", "bodies": ["ground", "beam"],
    "at": [0, 0, 0]}}}, "simulation": {"end_time": 1, "step": 1},
    "variables": {"size": )" +
                     variable + "}}");
}

ProblemFile read(const Json& document) {
  return read_problem_text(document.dump(), file).complete();
}

std::string complaint_about(const Json& document) {
  try {
    read(document);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

const std::string circle = R"({"type": "circle", "diameter": {"variable": "size"}})";

std::vector<double> values_of(const DesignVariable& variable) {
  std::vector<double> values;
  for (const SizeChoice& choice : variable.choices) values.push_back(choice.value);
  return values;
}

TEST(Choices, AreInAscendingOrderEachOnce) {
  const auto problem =
      read(beam_document(circle, R"({"choices": ["30 mm", "2 cm", 0.025, "20 mm"]})"));
  const DesignVariable& size = problem.variables.front();
  EXPECT_THAT(values_of(size), ElementsAre(0.02, 0.025, 0.03));
  EXPECT_EQ(size.choices[0].text, "2 cm");
  EXPECT_EQ(size.lower, 0.02);
  EXPECT_EQ(size.upper, 0.03);
  EXPECT_EQ(size.start, 0.025);  // in the middle
  EXPECT_EQ(size.unit, "mm");
}

TEST(Choices, MayHaveAStartAmongThem) {
  const auto start_of = [](const std::string& start) {
    return beam_document(circle, R"({"choices": ["20 mm", "30 mm"], "start": ")" + start + "\"}");
  };
  EXPECT_EQ(read(start_of("30 mm")).variables.front().start, 0.03);
  EXPECT_THAT(complaint_about(start_of("25 mm")),
              HasSubstr("/variables/size/start must be one of the choices, got \"25 mm\""));
}

TEST(Choices, HaveNoBounds) {
  EXPECT_THAT(complaint_about(beam_document(circle, R"({"choices": [1], "lower": 1})")),
              HasSubstr("/variables/size has the unknown key \"lower\""));
  EXPECT_THAT(complaint_about(beam_document(circle, R"({"choices": []})")),
              HasSubstr("/variables/size/choices must have at least one choice"));
  EXPECT_THAT(complaint_about(beam_document(circle, R"({"choices": ["-2 mm", "3 mm"]})")),
              HasSubstr("must be positive"));
}

TEST(Choices, OfSectionsAreSortedByArea) {
  const auto problem = read(beam_document(
      R"({"variable": "size"})",
      R"({"choices": ["CHS 42.4x2.6", "CHS 26.9x2.3", "CHS 33.7x2.6"], "start": "CHS 42.4x2.6"})"));
  const DesignVariable& size = problem.variables.front();
  EXPECT_EQ(size.start, 2.0);
  EXPECT_EQ(size.lower, 0.0);
  EXPECT_EQ(size.upper, 2.0);
  ASSERT_EQ(size.choices.size(), 3u);
  EXPECT_EQ(size.choices[0].text, "CHS 26.9x2.3");
  EXPECT_EQ(size.choices[1].text, "CHS 33.7x2.6");
}

TEST(Choices, OfSectionsAreThoseOfTheCatalogueAtWholeNumbers) {
  const std::vector<std::string> names = {"IPE 80", "IPE 100", "IPE 120"};
  const auto chosen = read(
      beam_document(R"({"variable": "size"})", R"({"choices": ["IPE 80", "IPE 100", "IPE 120"]})"));
  const auto section_of = [](const ProblemFile& problem) {
    return std::get<GeneralSection>(
        std::get<BeamBody>(problem.scene.bodies[0].shape).segments[0].section);
  };
  const GeneralSection path = section_of(chosen);
  for (std::size_t i = 0; i < names.size(); ++i) {
    Json document = beam_document(R"({"catalogue": ")" + names[i] + "\"}", "{}");
    document.erase("variables");
    const GeneralSection entry = section_of(read(document));
    const Design<double> at = {static_cast<double>(i)};
    EXPECT_EQ(resolve(path.area, at), entry.area.constant);
    EXPECT_EQ(resolve(path.inertia_y, at), entry.inertia_y.constant);
    EXPECT_EQ(resolve(path.inertia_z, at), entry.inertia_z.constant);
    EXPECT_EQ(resolve(path.torsion, at), entry.torsion.constant);
    ASSERT_EQ(path.points.size(), entry.points.size());
    for (std::size_t k = 0; k < entry.points.size(); ++k) {
      EXPECT_EQ(resolve(path.points[k].y, at), entry.points[k].y.constant);
      EXPECT_EQ(resolve(path.points[k].z, at), entry.points[k].z.constant);
      EXPECT_EQ(resolve(path.points[k].shear, at), entry.points[k].shear.constant);
    }
  }
}

TEST(Choices, OfSectionsSayWhatIsWrong) {
  const std::string section = R"({"variable": "size"})";
  EXPECT_THAT(complaint_about(beam_document(section, R"({"choices": ["CHS 26.9"]})")),
              AllOf(HasSubstr("/variables/size/choices/0"), HasSubstr("CHS 26.9")));
  EXPECT_THAT(complaint_about(beam_document(section, R"({"choices": ["IPE 80", "SHS 20x20x2"]})")),
              HasSubstr("must be sections of one type"));
  EXPECT_THAT(
      complaint_about(beam_document(R"({"variable": "sise"})", R"({"choices": ["IPE 80"]})")),
      HasSubstr("did you mean \"size\""));
  Json without = beam_document(section, R"({"choices": ["IPE 80"]})");
  without["scene"].erase("catalogue");
  EXPECT_THAT(complaint_about(without), HasSubstr("/scene names none"));
}

TEST(ValuePath, GoesThroughItsValuesAndNeverLeavesThoseBesideIt) {
  const std::vector<double> values = {1.0, 1.5, 4.0, 4.0, 3.0, 9.0};
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(path_point(values, static_cast<double>(i)).value, values[i]);
  }
  for (double at = 0.0; at < 5.0; at += 0.01) {
    const auto i = static_cast<std::size_t>(at);
    const auto [low, high] = std::minmax(values[i], values[i + 1]);
    EXPECT_GE(path_point(values, at).value, low - 1e-12) << at;
    EXPECT_LE(path_point(values, at).value, high + 1e-12) << at;
  }
}

TEST(ValuePath, HasTheSlopeOfItsDifferences) {
  const std::vector<double> values = {1.0, 1.5, 4.0, 4.5, 3.0, 9.0};
  constexpr double step = 1e-6;
  for (const double at : {0.0, 0.4, 1.0, 1.7, 2.0, 3.3, 4.0, 4.9, 5.0}) {
    const double difference =
        (path_point(values, at + step).value - path_point(values, at - step).value) / (2.0 * step);
    EXPECT_NEAR(path_point(values, at).slope, difference, 1e-4) << at;  // second derivatives jump
  }
}

TEST(ValuePath, IsTheStraightLineThroughValuesOnOne) {
  for (const double at : {-0.5, 0.0, 0.3, 1.0, 2.6, 3.0, 3.5}) {
    EXPECT_NEAR(path_point({1.0, 3.0, 5.0, 7.0}, at).value, 1.0 + 2.0 * at, 1e-13);
    EXPECT_NEAR(path_point({1.0, 3.0, 5.0, 7.0}, at).slope, 2.0, 1e-13);
  }
  EXPECT_EQ(path_point({4.0}, 0.0).value, 4.0);
}

}  // namespace
}  // namespace pleuel::test::choices_test
