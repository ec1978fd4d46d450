#include "core/scene/reading/mistakes.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/scene/good_problem.hpp"

namespace pleuel::test::mistakes_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

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
  EXPECT_THAT(mistakes(document), testing::ElementsAre(HasSubstr("/scene/bodies/crank/elements"),
                                                       HasSubstr("/scene/bodies/slider/mass"),
                                                       HasSubstr("/scene/joints/pin/bodies/1"),
                                                       HasSubstr("/simulation/step")));
  EXPECT_THAT(complaint(document), StartsWith("4 mistakes:\nbad.json: /scene/bodies/crank"));
}

TEST(Mistakes, OfResponsesAndConstraintsAreToldAtOnce) {
  Json document = good_json();
  document["responses"]["stress"]["body"] = "slider";
  document["responses"]["bow"]["direction"] = "w";
  EXPECT_THAT(mistakes(document), testing::ElementsAre(HasSubstr("/responses/stress/body"),
                                                       HasSubstr("/responses/bow/direction")));
  document = good_json();
  document["objective"]["minimize"] = "wait";
  document["constraints"]["strength"]["upper"] = "200 MPas";
  document["constraints"]["stiffness"]["response"] = "bough";
  EXPECT_THAT(mistakes(document),
              testing::ElementsAre(HasSubstr("/objective/minimize"),
                                   HasSubstr("/constraints/strength/upper"),
                                   HasSubstr("/constraints/stiffness/response")));
}

TEST(Mistakes, OfVariablesAndOfSettingsAreToldAtOnce) {
  Json document = good_json();
  document["variables"]["width"]["lower"] = "4 kg";
  document["variables"]["load"]["upper"] = "1 m";
  EXPECT_THAT(mistakes(document), testing::ElementsAre(HasSubstr("/variables/width/lower"),
                                                       HasSubstr("/variables/load/upper")));
  document = good_json();
  document["optimizer"]["starts"] = 0;
  document["accuracy"]["target"] = -1;
  EXPECT_THAT(mistakes(document),
              testing::ElementsAre(HasSubstr("/optimizer/starts"), HasSubstr("/accuracy/target")));
}

/// A body that cannot be read is still one that joints may name, and responses are not asked of it.
TEST(Mistakes, ThatFollowFromAnotherAreNotTold) {
  Json document = good_json();
  document["scene"]["bodies"]["rod"]["material"] = "stel";
  document["scene"]["bodies"]["crank"]["elements"] = 0;
  EXPECT_THAT(mistakes(document), testing::ElementsAre(HasSubstr("/scene/bodies/crank/elements"),
                                                       HasSubstr("/scene/bodies/rod/material")));
}

TEST(Mistakes, OfOneCaseAreToldWithItsName) {
  Json document = good_json();
  document["scene"]["bodies"]["crank"]["elements"] = 0;
  document["cases"] = {{"fast", {{"/simulation/step", "1 kg"}}}, {"slow", Json::object()}};
  EXPECT_THAT(mistakes(document),
              testing::ElementsAre(
                  AllOf(HasSubstr("/scene/bodies/crank/elements"), Not(HasSubstr("in the case"))),
                  AllOf(HasSubstr("/simulation/step"), HasSubstr("in the case \"fast\""))));
}

TEST(Mistakes, AreCountedWhereThereAreMany) {
  const std::vector<std::string> texts(20, "a mistake");
  const Mistakes error(texts);
  EXPECT_THAT(error.what(), StartsWith("20 mistakes:\na mistake\n"));
  EXPECT_THAT(error.what(), testing::EndsWith("\n… and 8 more"));
}

}  // namespace
}  // namespace pleuel::test::mistakes_test
