#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/packed_problem.hpp"
#include "core/scene/problem_numbers.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::load_case_test {
namespace {

/// A slider on a rail, pushed to and fro, with two variables, two masses and three limits.
Json rail() {
  return Json::parse(R"json({
    "constants": {"reach": "40 mm"},
    "scene": {
      "bodies": {
        "bar": {"type": "beam", "from": [0, 0, 0], "to": ["200 mm", 0, 0], "material": "steel",
                "section": {"type": "circle", "diameter": {"variable": "thick"}}, "elements": 2},
        "load": {"type": "point-mass", "at": ["200 mm", 0, 0], "mass": "2 kg"}},
      "joints": {
        "hub": {"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0],
                "drive": {"type": "constant-speed", "speed": "100 rpm"}},
        "clamp": {"type": "fixed", "bodies": ["bar", "load"], "at": ["200 mm", 0, 0]}
      }
    },
    "simulation": {"end_time": "0.1 s", "step": "1 ms"},
    "variables": {"thick": {"start": "10 mm", "lower": "5 mm", "upper": "30 mm"}},
    "responses": {
      "weight": {"type": "mass", "bodies": ["bar"]},
      "all": {"type": "mass"},
      "stress": {"type": "stress", "body": "bar", "over_time": "max"},
      "tip": {"type": "deflection", "body": "bar", "at": 1, "over_time": "max-abs"},
      "double_tip": {"type": "expression", "value": "2*tip"}
    },
    "objective": {"minimize": "weight"},
    "constraints": {"strength": {"response": "stress", "upper": "100 MPa"},
      "stiffness": {"response": "tip", "upper": "1 mm", "cases": ["fast"]},
      "size": {"linear": {"thick": 1}, "lower": "6 mm"}
    },
    "cases": {
      "slow": {},
      "fast": {"/scene/joints/hub/drive/speed": "300 rpm", "/simulation/step": "0.5 ms"},
      "loaded": {"/scene/bodies/load/mass": "5 kg"}
    }
  })json");
}

Json with(Json document, const std::string& pointer, const std::string& value) {
  return edited(std::move(document), pointer, value);
}

std::vector<std::string> names_of(const std::vector<ConstraintSettings>& constraints) {
  std::vector<std::string> names;
  for (const ConstraintSettings& one : constraints) names.push_back(one.name);
  return names;
}

std::vector<std::string> case_names(const ProblemFile& problem) {
  std::vector<std::string> names;
  for (const ProblemFile& one : problem.cases) names.push_back(one.load_case);
  return names;
}

TEST(LoadCase, ChangesWhatItsPointersLeadToAndNothingElse) {
  const ProblemFile problem = read(rail());
  ASSERT_THAT(case_names(problem), ElementsAre("slow", "fast", "loaded"));
  EXPECT_DOUBLE_EQ(problem.cases[0].simulation.step, 1e-3);
  EXPECT_DOUBLE_EQ(problem.cases[1].simulation.step, 5e-4);
  EXPECT_DOUBLE_EQ(problem.cases[2].simulation.step, 1e-3);
}

TEST(LoadCase, HasEachLimitOnceForEachCaseThatItIsFor) {
  const ProblemFile problem = read(rail());
  EXPECT_THAT(names_of(problem.constraints),
              ElementsAre("strength [slow]", "strength [fast]", "strength [loaded]",
                          "stiffness [fast]", "size"));
  EXPECT_THAT(names_of(problem.cases[0].constraints), ElementsAre("strength", "size"));
  EXPECT_EQ(problem.constraints[1].response, "stress [fast]");
}

TEST(LoadCase, LeavesMassesThatNoCaseChangesAsOneNumber) {
  const ProblemFile problem = read(rail());
  std::vector<std::string> names;
  for (const ResponseSettings& one : problem.responses) names.push_back(one.name);
  EXPECT_THAT(names, ElementsAre("weight", "all [slow]", "all [fast]", "all [loaded]",
                                 "stress [slow]", "stress [fast]", "stress [loaded]", "tip [slow]",
                                 "tip [fast]", "tip [loaded]", "double_tip [slow]",
                                 "double_tip [fast]", "double_tip [loaded]"));
  EXPECT_EQ(problem.objective->response, "weight");
}

TEST(LoadCase, ReadsFormulasWithTheResponsesOfItsOwn) {
  const ProblemFile problem = read(rail());
  const ResponseSettings& of_fast = problem.responses[11];
  ASSERT_EQ(of_fast.name, "double_tip [fast]");
  EXPECT_EQ(problem.responses[formula_of(of_fast)->arguments.front().index].name, "tip [fast]");
}

TEST(LoadCase, StandsForEachValueOfARange) {
  const Json named = with(rail(), "/constraints/stiffness/cases", R"(["sweep"])");
  const ProblemFile problem = read(with(named, "/cases", R"({"sweep": {
      "/scene/bodies/load/mass": "3 kg",
      "range": {"/simulation/step": {"from": "1 ms", "to": "4 ms", "count": 4}}}})"));
  EXPECT_THAT(case_names(problem),
              ElementsAre("sweep 1 ms", "sweep 2 ms", "sweep 3 ms", "sweep 4 ms"));
  EXPECT_DOUBLE_EQ(problem.cases[2].simulation.step, 3e-3);
  EXPECT_EQ(names_of(problem.constraints).size(), 4u + 4u + 1u);
}

TEST(LoadCase, IsAProblemOfItsOwnByItsName) {
  const ProblemFile fast = problem_of_case(read(rail()), "fast");
  EXPECT_FALSE(fast.has_cases());
  EXPECT_DOUBLE_EQ(fast.simulation.step, 5e-4);
  EXPECT_THAT(names_of(fast.constraints), ElementsAre("strength", "stiffness", "size"));
}

TEST(LoadCase, IsTheSameProblemWhereverItIsTakenFromTheFile) {
  const ProblemText text{
      with(rail(), "/pareto", R"({"constraint": "stiffness", "from": "1 mm", "to": "2 mm"})")
          .dump(),
      "bad.json",
      {},
      "loaded"};
  const ProblemFile bound = bind_numbers(
      text, {{"length",
              {"/scene/bodies/bar/to/0", "/scene/bodies/load/at/0", "/scene/joints/clamp/at/0"}}});
  EXPECT_THAT(names_of(bound.constraints), ElementsAre("strength", "size"));
  EXPECT_FALSE(bound.pareto);
  EXPECT_FALSE(bound.has_cases());
}

TEST(LoadCase, TakesAnObjectiveOverCases) {
  const ProblemFile worst =
      read(with(rail(), "/objective", R"({"minimize": "stress", "over_cases": "worst"})"));
  EXPECT_EQ(worst.objective->response, "stress [worst]");
  EXPECT_EQ(worst.responses.back().name, "stress [worst]");
  const ProblemFile weighted = read(with(
      rail(), "/objective", R"({"minimize": "stress", "over_cases": {"slow": 2, "fast": 1}})"));
  EXPECT_THAT(weighted.case_weights, ElementsAre(2.0, 1.0, 0.0));
}

TEST(LoadCase, SaysWhereAPointerLeadsNowhere) {
  const std::string text =
      complaint(with(rail(), "/cases/fast", R"({"/scene/joints/hub/drive/sped": "300 rpm"})"));
  EXPECT_THAT(text, HasSubstr("sped"));
  EXPECT_THAT(text, HasSubstr("fast"));
  EXPECT_THAT(complaint(with(rail(), "/cases/fast", R"({"/scene/joints/hubb/drive/speed": 1})")),
              HasSubstr("/scene/joints has no key \"hubb\"; did you mean \"hub\"?"));
}

TEST(LoadCase, ChangesNeitherVariablesNorGoals) {
  for (const std::string pointer : {"/variables/thick/start", "/objective/minimize",
                                    "/constraints/strength/upper", "/responses/tip/at"}) {
    const std::string text = complaint(with(rail(), "/cases/fast", "{\"" + pointer + "\": 1}"));
    EXPECT_THAT(text, HasSubstr("/cases/fast/~1")) << pointer;
    EXPECT_THAT(text, HasSubstr("must lead into /scene, /simulation, /effects or /constants"));
  }
  EXPECT_THAT(complaint(with(rail(), "/cases/fast", R"({"speed": 1})")),
              HasSubstr("/cases/fast/speed must be a JSON pointer"));
}

TEST(LoadCase, IsNamedWhereItsValuesAreWrong) {
  const std::string text =
      complaint(with(rail(), "/cases/fast", R"({"/scene/joints/hub/drive/speed": "300 kg"})"));
  EXPECT_THAT(text, HasSubstr("/scene/joints/hub/drive/speed"));
  EXPECT_THAT(text, HasSubstr("(in the case \"fast\")"));
}

TEST(LoadCase, IsNotNamedForWhatIsWrongInAllOfThem) {
  EXPECT_THAT(complaint(with(rail(), "/scene/bodies/bar/material", "\"stel\"")),
              Not(HasSubstr("in the case")));
}

TEST(LoadCase, HasToBeThereWhereALimitNamesIt) {
  EXPECT_THAT(complaint(with(rail(), "/constraints/stiffness/cases", R"(["fats"])")),
              HasSubstr("/constraints/stiffness/cases/0"));
  EXPECT_THAT(complaint(with(rail(), "/constraints/stiffness/cases", R"(["fats"])")),
              HasSubstr("did you mean \"fast\"?"));
  EXPECT_THAT(complaint(with(rail(), "/constraints/size/cases", R"(["fast"])")),
              HasSubstr("variables are the same in all cases"));
  EXPECT_THAT(complaint(with(rail(), "/cases", "remove")),
              HasSubstr("/constraints/stiffness/cases names cases, and the problem has none"));
}

TEST(LoadCase, AsksHowAnObjectiveThatDiffersIsMeant) {
  EXPECT_THAT(complaint(with(rail(), "/objective", R"({"minimize": "stress"})")),
              HasSubstr("/objective needs \"over_cases\""));
  EXPECT_THAT(complaint(with(rail(), "/objective", R"({"minimize": "stress"})")),
              HasSubstr("or take the number of one case, as in \"stress["));
  EXPECT_THAT(
      complaint(with(rail(), "/objective", R"({"minimize": "stress[slow"})")),
      HasSubstr("at column 7 of \"stress[slow\": the bracket [ of a load case is not closed"));
  EXPECT_THAT(
      complaint(with(rail(), "/objective", R"({"minimize": "weight", "over_cases": "worst"})")),
      HasSubstr("\"weight\" is the same in all"));
  EXPECT_THAT(complaint(with(rail(), "/objective",
                             R"({"minimize": "stress", "over_cases": {"slowly": 1}})")),
              HasSubstr("did you mean \"slow\"?"));
}

TEST(LoadCase, RefusesRangesThatSayTooLittle) {
  const auto of_range = [](const std::string& range) {
    return complaint(
        with(rail(), "/cases/fast", "{\"range\": {\"/simulation/step\": " + range + "}}"));
  };
  EXPECT_THAT(of_range(R"({"from": "1 ms", "to": "2 s", "count": 3})"),
              HasSubstr("unit of \"from\""));
  EXPECT_THAT(of_range(R"({"from": "1 ms", "to": "1 ms", "count": 3})"), HasSubstr("must differ"));
  EXPECT_THAT(of_range(R"({"from": "1 ms", "to": "2 ms", "count": 1})"), HasSubstr("count"));
}

TEST(LoadCase, KeepsVariablesTheSameWhereTheyFollowFromConstants) {
  Json document = with(rail(), "/variables/thick/upper", "\"= reach\"");
  EXPECT_EQ(complaint(document), "");
  EXPECT_THAT(complaint(with(document, "/cases/fast", R"({"/constants/reach": "20 mm"})")),
              HasSubstr("/variables/thick/upper must be the same in all cases"));
}

/// Of a constant that only a drive uses, a mass knows nothing; of one that a body uses it does, also by
/// way of another constant.
TEST(LoadCase, HasTheSameMassesWhereConstantsDoNotReachThem) {
  Json document = with(rail(), "/constants/speed", R"("100 rpm")");
  document["constants"]["long_reach"] = "= 2*reach";
  document["scene"]["joints"]["hub"]["drive"]["speed"] = "= speed";
  document["cases"]["fast"] = Json::parse(R"({"/constants/speed": "300 rpm"})");
  EXPECT_EQ(complaint(document), "");
  document["objective"]["over_cases"] = "worst";
  EXPECT_EQ(complaint(document), "") << "who says how they count may";
  document["objective"].erase("over_cases");
  document["cases"]["fast"] = Json::parse(R"({"/constants/reach": "50 mm"})");
  EXPECT_EQ(complaint(document), "");
  document["scene"]["bodies"]["bar"]["section"] =
      Json::parse(R"({"type": "circle", "diameter": "= thick + 0.01*long_reach"})");
  EXPECT_THAT(complaint(document), HasSubstr("/objective needs \"over_cases\""));
  // Nor does it of one that only a body uses which is not weighed.
  document = with(rail(), "/scene/bodies/load/mass", R"("= reach*10 kg/m")");
  document["cases"]["fast"] = Json::parse(R"({"/constants/reach": "50 mm"})");
  EXPECT_EQ(complaint(document), "");
  document["objective"] = Json::parse(R"({"minimize": "all"})");
  EXPECT_THAT(complaint(document), HasSubstr("/objective needs \"over_cases\""));
}

TEST(LoadCase, ChangesConstantsThatThereAre) {
  Json document = with(rail(), "/variables/thick/upper", "\"= reach\"");
  EXPECT_THAT(complaint(with(document, "/cases/fast", R"({"/constants/reech": "20 mm"})")),
              HasSubstr("/cases/fast/~1constants~1reech names the unknown constant \"reech\"; did "
                        "you mean \"reach\"?"));
}

/// The rail with a number that is made from two cases, and a limit on it.
Json across() {
  Json document = rail();
  document["responses"]["gap"] = {{"type", "expression"}, {"value", "tip[fast] - tip[slow]"}};
  document["constraints"]["evenness"] = {{"response", "gap"}, {"upper", "0.5 mm"}};
  return document;
}

TEST(AcrossCases, AreReadBesideTheResponsesOfTheCases) {
  const ProblemFile problem = read(across());
  const ResponseSettings& gap = problem.responses.back();
  ASSERT_EQ(gap.name, "gap");
  EXPECT_TRUE(is_over_cases(problem, problem.responses.size() - 1));
  EXPECT_EQ(problem.responses[formula_of(gap)->arguments[0].index].name, "tip [fast]");
  EXPECT_EQ(problem.responses[formula_of(gap)->arguments[1].index].name, "tip [slow]");
  EXPECT_EQ(problem.constraints.back().name, "evenness");
  for (const ProblemFile& one : problem.cases) {
    EXPECT_EQ(one.responses.size(), 5u);
    EXPECT_THAT(names_of(one.constraints), Not(testing::Contains("evenness")));
  }
}

TEST(AcrossCases, MayBeWrittenAsTablesShowThem) {
  for (const char* formula : {"tip[fast] - tip[slow]", "tip [fast] - tip[ slow ]",
                              "'tip [fast]' - 'tip'[slow]", "= tip[fast] - 'tip [slow]'"}) {
    const ProblemFile problem =
        read(with(across(), "/responses/gap/value", fmt::format("\"{}\"", formula)));
    EXPECT_EQ(formula_of(problem.responses.back())->arguments.size(), 2u) << formula;
  }
}

TEST(AcrossCases, MayBeObjectiveAndLimitByTheirNames) {
  Json document = with(across(), "/objective", R"({"minimize": "tip[slow]"})");
  document["constraints"]["strength"] = {{"response", "stress [loaded]"}, {"upper", "100 MPa"}};
  const ProblemFile problem = read(document);
  EXPECT_EQ(problem.objective->response, "tip [slow]");
  EXPECT_EQ(find_named(problem.constraints, "strength")->response, "stress [loaded]");
  EXPECT_FALSE(problem.cases.front().objective);
}

TEST(AcrossCases, TakeResponsesThatAreTheSameInAllAsTheyAre) {
  Json document = across();
  document["responses"]["gap"]["value"] = "weight*tip[fast]";
  document["constraints"]["evenness"]["upper"] = "0.5 kg mm";
  const ProblemFile problem = read(document);
  const Expression& formula = *formula_of(problem.responses.back());
  EXPECT_EQ(problem.responses[formula.arguments[0].index].name, "weight");
}

TEST(AcrossCases, UseVariablesThatNothingElseUses) {
  Json document = across();
  document["variables"]["extra"] = {{"start", "1 mm"}, {"lower", "0 mm"}, {"upper", "2 mm"}};
  document["responses"]["gap"]["value"] = "tip[fast] - tip[slow] + extra";
  EXPECT_EQ(read(document).variables.size(), 2u);
  EXPECT_EQ(problem_of_case(read(document), "slow").variables.size(), 2u);
}

std::string complaint_of(const std::string& formula) {
  return complaint(with(across(), "/responses/gap/value", "\"" + formula + "\""));
}

TEST(AcrossCases, SayWhatIsWrongWithNamesAndUnits) {
  EXPECT_THAT(complaint_of("tip[fats] - tip[slow]"),
              AllOf(HasSubstr("/responses/gap/value"), HasSubstr("column 1"),
                    HasSubstr("\"tip\" has no case \"fats\"; did you mean \"fast\"?")));
  EXPECT_THAT(
      complaint_of("tip[fast] - tip[quick]"),
      AllOf(HasSubstr("column 13"), HasSubstr("known are \"slow\", \"fast\" and \"loaded\"")));
  EXPECT_THAT(complaint_of("tpi[fast] - tip[slow]"), HasSubstr("did you mean \"tip\"?"));
  EXPECT_THAT(complaint_of("tip[fast] - tip"),
              AllOf(HasSubstr("column 13"),
                    HasSubstr("\"tip\" differs from case to case: name one of them, as in "
                              "\"tip[slow]\"; there are \"slow\", \"fast\" and \"loaded\"")));
  EXPECT_THAT(complaint_of("weight[fast]*tip[slow]"),
              HasSubstr("\"weight\" is no number of one load case: leave \"[fast]\" out"));
  EXPECT_THAT(complaint_of("tip[fast] - stress[slow]"), HasSubstr("units differ"));
  EXPECT_THAT(complaint_of("tip[fast"), HasSubstr("the bracket [ of a load case is not closed"));
}

TEST(AcrossCases, NameTheCasesOfConstantsThatDiffer) {
  Json document = across();
  document["cases"]["fast"]["/constants/reach"] = "50 mm";
  document["objective"]["over_cases"] = "worst";  // masses may follow from constants
  document["responses"]["gap"]["value"] = "tip[fast] + reach[fast] - reach[slow]";
  const ProblemFile problem = read(document);
  EXPECT_EQ(formula_of(*find_named(problem.responses, "gap"))->arguments.size(), 1u);
  document["responses"]["gap"]["value"] = "tip[fast] + reach";
  EXPECT_THAT(complaint(document), HasSubstr("\"reach\" differs from case to case"));
}

TEST(AcrossCases, SayNotTwiceWhichCasesAreMeant) {
  EXPECT_THAT(complaint(with(across(), "/constraints/evenness/cases", R"(["fast"])")),
              AllOf(HasSubstr("/constraints/evenness/cases"), HasSubstr("names its cases itself")));
  EXPECT_THAT(
      complaint(with(across(), "/objective", R"({"minimize": "gap", "over_cases": "worst"})")),
      HasSubstr("/objective/over_cases"));
}

TEST(AcrossCases, NeedCases) {
  Json document = across();
  document.erase("cases");
  document["constraints"]["stiffness"].erase("cases");
  EXPECT_THAT(complaint(document),
              AllOf(HasSubstr("/responses/gap/value"), HasSubstr("\"[fast]\" names a load case")));
  EXPECT_THAT(complaint(with(rail(), "/scene/bodies/load/mass", R"x("= 2 kg*tip[fast]/(1 m)")x")),
              HasSubstr("names a load case"));
}

// What load cases must have in common, and names that would stand for two things.

/// A bar under a force at its tip, which is larger in one of two cases.
Json bar() {
  return Json::parse(R"json({
    "constants": {"size": "6 mm", "share": 1},
    "scene": {
      "bodies": {
        "bar": {"type": "beam", "from": [0, 0, 0], "to": ["200 mm", 0, 0], "material": "steel",
                "section": {"type": "rectangle", "width": {"variable": "width"},
                            "height": {"variable": "height"}}, "elements": 2}},
      "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
      "loads": {"weight": {"type": "force", "body": "bar", "at": ["200 mm", 0, 0],
                           "direction": [0, -1, 0], "value": "100 N"}}},
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
  return thrown<InputError>([&] {
    read_problem_text(document.dump(), source_folder() + "/problems/any.json").complete();
  });
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

namespace fs = std::filesystem;

/// What is unpacked is packed to the same bytes: nothing is lost or rounded. That all members of a
/// struct are named, the compiler sees.
TEST(PackedProblem, IsTheSameWhenItIsUnpacked) {
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source_folder() + "/problems")) {
    const fs::path& path = entry.path();
    if (path.extension() != ".json" || path.string().find("schema") != std::string::npos) continue;
    ProblemFile problem;
    try {
      problem = read_problem(path).complete();
    } catch (const std::exception&) {
      continue;  // a catalogue, a material
    }
    ++files;
    const std::string bytes = packed(problem);
    EXPECT_EQ(packed(unpacked<ProblemFile>(bytes)), bytes) << path;
  }
  EXPECT_GE(files, 20);
}

TEST(PackedProblem, KeepsWhatNoFileSays) {
  ProblemFile problem =
      read_problem(source_folder() + "/problems/slider_crank_round.json").complete();
  problem.effects.decisions = {};
  problem.effects.decisions.measured[{"rod", "elasticity"}] = {false, 1e-3, "rod_bow"};
  problem.simulation.checks_resolution = false;
  problem.simulation.moves_by_bending = true;
  problem.simulation.instants = {0.0, 0.1 / 3.0};
  const auto same = unpacked<ProblemFile>(packed(problem));
  const MeasuredEffect& effect = same.effects.decisions.measured.at({"rod", "elasticity"});
  EXPECT_FALSE(effect.is_needed);
  EXPECT_EQ(effect.response, "rod_bow");
  EXPECT_FALSE(same.simulation.checks_resolution);
  EXPECT_TRUE(same.simulation.moves_by_bending);
  EXPECT_EQ(same.simulation.instants, problem.simulation.instants);
  EXPECT_EQ(same.variables[0].quantity, problem.variables[0].quantity);
}

}  // namespace
}  // namespace pleuel::test::load_case_test
