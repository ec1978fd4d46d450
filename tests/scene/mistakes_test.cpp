#include "core/scene/reading/mistakes.hpp"

#include <fstream>
#include <iterator>
#include <string_view>

#include "core/base/error.hpp"
#include "core/scene/material_library.hpp"
#include "core/scene/reading/other_names.hpp"
#include "core/scene/reading/suggestion.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::mistakes_test {
namespace {

std::vector<std::string> mistakes(const Json& document) {
  try {
    read(document);
  } catch (const InputError& error) {
    return mistakes_of(error);
  }
  return {};
}

TEST(Mistakes, OfOneSectionAreToldAtOnce) {
  Json document = good_json();
  document["scene"]["bodies"]["crank"]["elements"] = 0;
  document["scene"]["bodies"]["slider"]["mass"] = -1;
  document["scene"]["joints"]["pin"]["bodies"][1] = "rood";
  document["simulation"]["step"] = "1 kg";
  EXPECT_THAT(
      mistakes(document),
      ElementsAre(HasSubstr("/scene/bodies/crank/elements"), HasSubstr("/scene/bodies/slider/mass"),
                  HasSubstr("/scene/joints/pin/bodies/1"), HasSubstr("/simulation/step")));
  EXPECT_THAT(complaint(document), StartsWith("4 mistakes:\nbad.json: /scene/bodies/crank"));
}

TEST(Mistakes, OfResponsesAndConstraintsAreToldAtOnce) {
  Json document = good_json();
  document["responses"]["stress"]["body"] = "slider";
  document["responses"]["bow"]["direction"] = "w";
  EXPECT_THAT(mistakes(document), ElementsAre(HasSubstr("/responses/stress/body"),
                                              HasSubstr("/responses/bow/direction")));
  document = good_json();
  document["objective"]["minimize"] = "wait";
  document["constraints"]["strength"]["upper"] = "200 MPas";
  document["constraints"]["stiffness"]["response"] = "bough";
  EXPECT_THAT(mistakes(document), ElementsAre(HasSubstr("/objective/minimize"),
                                              HasSubstr("/constraints/strength/upper"),
                                              HasSubstr("/constraints/stiffness/response")));
}

TEST(Mistakes, OfVariablesAndOfSettingsAreToldAtOnce) {
  Json document = good_json();
  document["variables"]["width"]["lower"] = "4 kg";
  document["variables"]["load"]["upper"] = "1 m";
  EXPECT_THAT(mistakes(document),
              ElementsAre(HasSubstr("/variables/width/lower"), HasSubstr("/variables/load/upper")));
  document = good_json();
  document["optimizer"]["starts"] = 0;
  document["accuracy"]["target"] = -1;
  EXPECT_THAT(mistakes(document),
              ElementsAre(HasSubstr("/optimizer/starts"), HasSubstr("/accuracy/target")));
}

/// A body that cannot be read is still one that joints may name, and responses are not asked of it.
TEST(Mistakes, ThatFollowFromAnotherAreNotTold) {
  Json document = good_json();
  document["scene"]["bodies"]["rod"]["material"] = "stel";
  document["scene"]["bodies"]["crank"]["elements"] = 0;
  EXPECT_THAT(mistakes(document), ElementsAre(HasSubstr("/scene/bodies/crank/elements"),
                                              HasSubstr("/scene/bodies/rod/material")));
}

TEST(Mistakes, OfOneCaseAreToldWithItsName) {
  Json document = good_json();
  document["scene"]["bodies"]["crank"]["elements"] = 0;
  document["cases"] = {{"fast", {{"/simulation/step", "1 kg"}}}, {"slow", Json::object()}};
  EXPECT_THAT(
      mistakes(document),
      ElementsAre(AllOf(HasSubstr("/scene/bodies/crank/elements"), Not(HasSubstr("in the case"))),
                  AllOf(HasSubstr("/simulation/step"), HasSubstr("in the case \"fast\""))));
}

TEST(Mistakes, AreCountedWhereThereAreMany) {
  const std::vector<std::string> texts(20, "a mistake");
  const Mistakes error(texts);
  EXPECT_THAT(error.what(), StartsWith("20 mistakes:\na mistake\n"));
  EXPECT_THAT(error.what(), EndsWith("\n… and 8 more"));
}

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("steel", "steel"), 0U);
  EXPECT_EQ(edit_distance("stel", "steel"), 1U);
  EXPECT_EQ(edit_distance("steeel", "steel"), 1U);
  EXPECT_EQ(edit_distance("steel", "steal"), 1U);
  EXPECT_EQ(edit_distance("setel", "steel"), 1U);
  EXPECT_EQ(edit_distance("", "steel"), 5U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);  // the textbook example
}

TEST(EditDistance, IsSymmetric) {
  EXPECT_EQ(edit_distance("thickness", "thicknes"), edit_distance("thicknes", "thickness"));
  EXPECT_EQ(edit_distance("sitting", "kitten"), 3U);
}

TEST(Suggestion, IsTheNearestOfTheNearWords) {
  EXPECT_EQ(closest("diamter", {"type", "diameter", "outer_diameter"}), "diameter");
  EXPECT_EQ(closest("rod_2", {"rod_10", "rod_21", "crank"}), "rod_21");
}

TEST(Suggestion, IsWhatOthersCallSo) {
  EXPECT_EQ(meant_by("E", {"young", "poisson", "density"}), "young");
  EXPECT_EQ(meant_by("rho", {"young", "poisson", "density"}), "density");
  EXPECT_EQ(meant_by("hinge", {"fixed", "prismatic", "revolute"}), "revolute");
  EXPECT_EQ(meant_by("aluminum", {"steel", "aluminium-6082-T6"}), "aluminium-6082-T6");
  EXPECT_EQ(meant_by("STEEL", {"steel", "pom"}), "steel");
  EXPECT_EQ(meant_by("von_mises", {"mass", "stress"}), "stress");
  EXPECT_EQ(meant_by("hinge", {"mass", "stress"}), "");
  EXPECT_EQ(meant_by("diamter", {"type", "diameter"}), "diameter");
  EXPECT_EQ(closest("hinge", {"fixed", "prismatic", "revolute"}), "");
  EXPECT_EQ(meant_by("yields", {"height", "width"}), "");
}

/// Names that other_names.hpp leads to are words of the schema or of the materials.
TEST(Suggestion, LeadsToWordsThatThereAre) {
  std::ifstream stream(source_folder() + "/problems/problem.schema.json");
  const std::string schema{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_FALSE(schema.empty());
  const std::vector<Material> library = material_library();
  for (const auto& row : other_names) {
    const std::string_view name = row.second;
    const bool is_material =
        std::any_of(library.begin(), library.end(),
                    [&](const Material& material) { return material.name.starts_with(name); });
    const bool is_word = schema.find(fmt::format("\"{}\"", name)) != std::string::npos;
    EXPECT_TRUE(is_material || is_word) << name;
  }
}

TEST(Suggestion, IsAbsentForWordsThatHaveNothingInCommon) {
  EXPECT_EQ(closest("colour", {"type", "diameter"}), "");
  EXPECT_EQ(closest("a", {"b"}), "");
  EXPECT_EQ(closest("x", {}), "");
}

TEST(Suggestion, IsAbsentForAWordOfAbsurdLength) {
  EXPECT_EQ(closest(std::string(100000, 'x'), {std::string(100001, 'x')}), "");
}

TEST(Hint, NamesTheKnownWordsIfNoneIsNear) {
  EXPECT_EQ(hint("colour", {"type", "width", "height"}),
            "; known are \"type\", \"width\" and \"height\"");
  EXPECT_EQ(hint("colour", {"type"}), "; known is \"type\"");
  EXPECT_EQ(hint("colour", {}), "; there are none");
}

}  // namespace
}  // namespace pleuel::test::mistakes_test
