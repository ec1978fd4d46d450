#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/source_folder.hpp"

/// What load cases must have in common, and names that would stand for two things.
namespace pleuel::test::shared_by_cases_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A bar under a force at its tip, which is larger in one of two cases.
Json bar() {
  return Json::parse(R"json({
    "constants": {"size": "6 mm", "share": 1},
    "scene": {
      "bodies": {
        "bar": {"type": "beam", "from": [0, 0, 0], "to": ["200 mm", 0, 0], "material": "steel",
                "section": {"type": "rectangle", "width": {"variable": "width"},
                            "height": {"variable": "height"}}, "elements": 2}
      },
      "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
      "loads": {"weight": {"type": "force", "body": "bar", "at": ["200 mm", 0, 0],
                           "direction": [0, -1, 0], "value": "100 N"}}
    },
    "simulation": {"end_time": "0.1 s", "step": "1 ms"},
    "variables": {"width": {"start": "10 mm", "lower": "5 mm", "upper": "30 mm"},
                  "height": {"start": "10 mm", "lower": "5 mm", "upper": "30 mm"}},
    "responses": {
      "weight": {"type": "mass"},
      "stress": {"type": "stress", "body": "bar", "over_time": "max"},
      "tip": {"type": "deflection", "body": "bar", "at": 1, "over_time": "max-abs"},
      "scaled": {"type": "expression", "value": "tip*share"}
    },
    "objective": {"minimize": "tip", "over_cases": "worst"},
    "constraints": {"stiffness": {"response": "tip", "upper": "1 mm"}},
    "cases": {"light": {}, "heavy": {"/scene/loads/weight/value": "200 N"}}
  })json");
}

/// The bar with a constant that the heavy case changes.
Json with_constant(const std::string& name, const char* value) {
  Json document = bar();
  document["cases"]["heavy"]["/constants/" + name] = value;
  return document;
}

const char* const is_shared =
    "must be the same in all cases, but follows from a constant that the case \"heavy\" changes";

TEST(SharedByCases, AreLimitsOnVariablesAndOnMasses) {
  Json document = with_constant("size", "8 mm");
  document["constraints"]["slim"] = {{"linear", {{"width", 1}}}, {"lower", "= size"}};
  EXPECT_THAT(complaint(document), HasSubstr(std::string("/constraints/slim/lower ") + is_shared));
  document["constraints"]["slim"] = {{"response", "weight"}, {"upper", "= size*(1 kg/m)"}};
  EXPECT_EQ(complaint(document), "");  // masses may follow from constants: a limit in each case
}

TEST(SharedByCases, IsTheScatter) {
  Json document = with_constant("size", "8 mm");
  document["uncertainty"] = {{"parameters", {{"width", {{"deviation", "= size/100"}}}}}};
  EXPECT_THAT(complaint(document),
              HasSubstr(std::string("/uncertainty/parameters/width/deviation ") + is_shared));
  document["uncertainty"] = {{"parameters", {{"width", {{"interval", "= size/100"}}}}}};
  EXPECT_THAT(complaint(document),
              HasSubstr(std::string("/uncertainty/parameters/width/interval ") + is_shared));
}

TEST(SharedByCases, AreTheStartsOfTheSearch) {
  Json document = with_constant("size", "8 mm");
  document["optimizer"] = {{"starts", {{{"height", "20 mm"}}, {{"width", "= size"}}}}};
  EXPECT_THAT(complaint(document),
              HasSubstr(std::string("/optimizer/starts/1/width ") + is_shared));
}

TEST(SharedByCases, AreTheChoicesOfVariables) {
  Json document = with_constant("size", "8 mm");
  document["variables"]["width"] = {{"choices", {"5 mm", "= size", "10 mm"}}};
  EXPECT_THAT(complaint(document), HasSubstr(std::string("/variables/width/choices ") + is_shared));
}

/// Read in the folder of the shipped problems.
std::string complaint_with_catalogue(const Json& document) {
  try {
    read_problem_text(document.dump(), source_folder() + "/problems/any.json").complete();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SharedByCases, IsTheCatalogueThatAVariableIsChosenFrom) {
  Json document = bar();
  document["scene"]["catalogue"] = "catalogue.json";
  document["cases"]["heavy"]["/scene/catalogue"] = "catalogue.json";
  EXPECT_EQ(complaint_with_catalogue(document), "");  // nothing is chosen from it
  document["scene"]["bodies"]["bar"]["section"] = {{"variable", "beam"}};
  document["variables"] = {{"beam", {{"choices", {"IPE 80", "IPE 100"}}, {"start", "IPE 80"}}}};
  EXPECT_THAT(complaint_with_catalogue(document),
              AllOf(HasSubstr("/cases/heavy/~1scene~1catalogue must not change the catalogue"),
                    HasSubstr("\"beam\"")));
}

TEST(SharedByCases, IsWhatAConstantMeasures) {
  EXPECT_THAT(complaint(with_constant("share", "2 N")),
              AllOf(HasSubstr("/cases/heavy/~1constants~1share must leave the constant \"share\""),
                    HasSubstr("a number without unit")));
  EXPECT_NE(complaint(with_constant("share", "1 deg")), "");  // angles count
  Json document = bar();
  document["cases"]["heavy"]["/constants/share"] = 3;
  EXPECT_EQ(complaint(document), "");
  document["cases"]["heavy"]["/constants/size"] = 0;  // as well no length
  EXPECT_EQ(complaint(document), "");
}

TEST(SharedByCases, IsWhatAResponseMeasures) {
  Json document = bar();
  document["scene"]["joints"]["wall"] = {
      {"type", "revolute"}, {"bodies", {"ground", "bar"}}, {"at", {0, 0, 0}}};
  document["responses"]["turn"] = {
      {"type", "joint-position"}, {"joint", "wall"}, {"over_time", "max"}};
  document["responses"]["move"] = {{"type", "expression"}, {"value", "turn*share"}};
  EXPECT_EQ(complaint(document), "");
  document["cases"]["heavy"]["/scene/joints/wall"] = {
      {"type", "prismatic"}, {"bodies", {"ground", "bar"}}, {"at", {0, 0, 0}}, {"axis", {1, 0, 0}}};
  EXPECT_THAT(complaint(document),
              AllOf(HasSubstr("/responses/turn must measure the same in all cases"),
                    HasSubstr("an angle [rad] in the case \"light\""),
                    HasSubstr("a length [m] in \"heavy\"")));
}

TEST(SharedByCases, AreTheWeightsOfARangeOrThoseOfItsCases) {
  Json document = bar();
  document["cases"]["heavy"] = {
      {"range",
       {{"/scene/loads/weight/value", {{"from", "200 N"}, {"to", "400 N"}, {"count", 2}}}}}};
  document["objective"]["over_cases"] = {{"heavy", 1}, {"light", 2}};
  EXPECT_EQ(complaint(document), "");
  document["objective"]["over_cases"] = {{"heavy", 1}, {"heavy 400 N", 2}};
  EXPECT_THAT(complaint(document),
              HasSubstr("/objective/over_cases/heavy 400 N gives the case \"heavy 400 N\" a second "
                        "weight, beside that of \"heavy\""));
  document["objective"]["over_cases"] = "worst";
  document["pareto"]["responses"] = {
      "weight", {{"minimize", "tip"}, {"over_cases", {{"heavy 400 N", 2}, {"heavy", 1}}}}};
  EXPECT_THAT(complaint(document),
              HasSubstr("/pareto/responses/1/over_cases/heavy gives the case"));
}

std::string complaint_of_names(const std::string& one, const std::string& other) {
  Json document = bar();
  document["cases"] = {{one, Json::object()}, {other, Json::object()}};
  return complaint(document);
}

TEST(NamesOfCases, HaveFilesOfTheirOwn) {
  EXPECT_THAT(complaint_of_names("a b", "a_b"),
              HasSubstr("/cases/a_b must have another name: files of the case \"a_b\" would be "
                        "named as those of \"a b\""));
  EXPECT_THAT(complaint_of_names("a", ".."), HasSubstr("/cases/.. must have another name"));
  EXPECT_EQ(complaint_of_names("a b", "a-b"), "");
}

TEST(NamesOfCases, CanBeWrittenInFormulas) {
  EXPECT_THAT(complaint_of_names("a", " a"), HasSubstr("without blanks at its ends"));
  EXPECT_THAT(complaint_of_names("a", "b[1]"), HasSubstr("without brackets"));
}

TEST(NamesOfCases, StandBehindNoOtherName) {
  Json document = bar();
  document["constraints"]["stiffness [heavy]"] = {{"response", "weight"}, {"upper", "1 kg"}};
  EXPECT_THAT(complaint(document), HasSubstr("/constraints/stiffness [heavy] must have another"));
  document = bar();
  document["responses"]["tip[heavy]"] = {{"type", "mass"}};
  EXPECT_THAT(complaint(document), HasSubstr("/responses/tip[heavy] must have another name"));
}

TEST(NamesInBrackets, AreNamesLikeOthersWithoutCases) {
  Json document = bar();
  document.erase("cases");
  document["objective"].erase("over_cases");
  document["responses"]["tip[1]"] = document["responses"]["tip"];
  document["constraints"]["stiff[1]"] = {{"response", "tip[1]"}, {"upper", "1 mm"}};
  document["pareto"] = {{"responses", {"weight", "tip[1]"}}};
  EXPECT_EQ(read(document).pareto->goals[1].response, "tip[1]");
  document["pareto"] = {{"constraint", "stiff[1]"}, {"from", "1 mm"}, {"to", "2 mm"}};
  EXPECT_EQ(read(document).pareto->constraint, "stiff[1]");
}

TEST(ChangesOfACase, DoNotUndoEachOther) {
  Json document = bar();
  const Json weight = document["scene"]["loads"]["weight"];
  document["cases"]["heavy"] = {{"/scene/loads/weight", weight},
                                {"/scene/loads/weight/value", "300 N"}};
  EXPECT_EQ(complaint(document), "");
  document["cases"]["heavy"] = {{"/scene/loads/weight/value", "300 N"},
                                {"/scene/loads/weight", weight}};
  EXPECT_THAT(complaint(document), HasSubstr("/cases/heavy replaces \"/scene/loads/weight\""));
}

TEST(AccuracyOfNumbersOverCases, IsThatOfTheirParts) {
  Json document = bar();
  document["responses"]["gap"] = {{"type", "expression"},
                                  {"value", "tip[heavy] - stress[light]*(1 m/Pa)"}};
  document["responses"]["twice"] = {{"type", "expression"}, {"value", "2*gap + 'tip [heavy]'"}};
  document["objective"] = {{"minimize", "weight"}};
  document["accuracy"] = {{"responses", {"twice"}}};
  const ProblemFile problem = read(document);
  EXPECT_THAT(problem.cases[0].accuracy.responses, ElementsAre("stress"));
  EXPECT_THAT(problem.cases[1].accuracy.responses, ElementsAre("tip"));
  document["accuracy"] = {{"responses", {"tip[light]"}}};
  EXPECT_THAT(read(document).cases[0].accuracy.responses, ElementsAre("tip"));
  EXPECT_THAT(read(document).cases[1].accuracy.responses, ElementsAre());
  document["accuracy"] = {{"responses", {"tip[lihgt]"}}};
  EXPECT_THAT(complaint(document), HasSubstr("/accuracy/responses/0 names the unknown response"));
}

TEST(NumbersOverCases, AreNotTakenForUnitsOfTheirName) {
  Json document = bar();
  document["responses"]["s"] = {{"type", "expression"}, {"value", "tip[heavy] + tip[light]"}};
  document["responses"]["rate"] = {{"type", "expression"}, {"value", "tip/(2 s)"}};
  const ProblemFile problem = read(document);
  EXPECT_NE(find_named(problem.responses, "rate [light]"), nullptr);
  document["responses"]["rate"]["value"] = "tip[heavy]/(2*s)";
  EXPECT_NE(find_named(read(document).responses, "rate"), nullptr);
}

TEST(FrontsOverCases, MayBeBetweenTwoWaysToPutOneResponseTogether) {
  Json document = bar();
  document["pareto"]["responses"] = {{{"minimize", "tip"}, {"over_cases", "sum"}},
                                     {{"minimize", "tip"}, {"over_cases", "worst"}}};
  EXPECT_EQ(read(document).pareto->goals.size(), 2u);
  document["pareto"]["responses"] = {{{"minimize", "tip"}, {"over_cases", {{"light", 1}}}},
                                     {{"minimize", "tip"}, {"over_cases", {{"heavy", 1}}}}};
  ProblemFile problem = read(document);
  const Objective light = goal_of_problem(problem, problem.pareto->goals[0]);
  EXPECT_NE(goal_of_problem(problem, problem.pareto->goals[1]).response, light.response);
  document["pareto"]["responses"][1] = document["pareto"]["responses"][0];
  EXPECT_THAT(complaint(document), HasSubstr("must be two different responses"));
}

TEST(LimitsOnVariables, HaveTheirUnitsWhereOneCaseDoesNotUseThem) {
  Json document = bar();
  document["variables"]["force"] = {{"start", "200 N"}, {"lower", "100 N"}, {"upper", "300 N"}};
  document["constraints"]["least"] = {{"linear", {{"force", 1}}}, {"lower", "150 N"}};
  document["cases"]["heavy"]["/scene/loads/weight/value"] = {{"variable", "force"}};
  const ProblemFile problem = read(document);
  EXPECT_DOUBLE_EQ(*find_named(problem.constraints, "least")->lower, 150.0);
}

}  // namespace
}  // namespace pleuel::test::shared_by_cases_test
