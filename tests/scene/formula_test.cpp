#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/response_quantity.hpp"
#include "core/scene/shown_unit.hpp"
#include "core/scene/variable_quantity.hpp"
#include "tests/scene/good_problem.hpp"

/// Formulas in a problem file: in place of numbers, and as responses.
namespace pleuel::test::formula_test {
namespace {

constexpr const char* section = "/scene/bodies/crank/section/height";

Json with_constants() {
  Json document = good_json();
  document["constants"] = {{"stroke", "80 mm"}, {"half", "= stroke/2"}, {"ratio", 2.5}};
  return document;
}

double height(const Json& document, const Design<double>& design) {
  const ProblemFile problem = read(document);
  const auto& crank = std::get<BeamBody>(problem.scene.bodies[0].shape);
  return resolve(std::get<RectangleSection>(crank.segments[0].section).height, design);
}

std::string complaint_with(const std::string& pointer, const std::string& formula) {
  Json document = with_constants();
  document[Json::json_pointer(pointer)] = formula;
  return complaint(document);
}

TEST(Formula, OfConstantsStandsForAnyNumber) {
  Json document = with_constants();
  document["scene"]["bodies"]["wheel"]["mass"] = "= ratio*3 kg";
  document["simulation"]["end_time"] = "= ratio*40 ms";
  document["constraints"]["stiffness"]["upper"] = "= half/200";
  document["variables"]["width"]["upper"] = "= stroke - 2 cm";
  const ProblemFile problem = read(document);
  EXPECT_DOUBLE_EQ(std::get<RigidBody>(problem.scene.bodies[3].shape).mass.constant, 7.5);
  EXPECT_FALSE(std::get<RigidBody>(problem.scene.bodies[3].shape).mass.is_bound());
  EXPECT_DOUBLE_EQ(problem.simulation.end_time, 0.1);
  EXPECT_DOUBLE_EQ(*problem.constraints[1].upper, 0.0002);
  EXPECT_DOUBLE_EQ(problem.variables[0].upper, 0.06);
}

TEST(Formula, OfVariablesStandsForANumberOfTheScene) {
  Json document = with_constants();
  document[Json::json_pointer(section)] = "= 2*width + half/10 + 1 mm";
  EXPECT_DOUBLE_EQ(height(document, {0.02, 0.03, 0.3}), 0.045);
  const ProblemFile problem = read(document);
  const auto& crank = std::get<BeamBody>(problem.scene.bodies[0].shape);
  const Number number = std::get<RectangleSection>(crank.segments[0].section).height;
  EXPECT_EQ(number.variables(), std::vector<int>{0});
  EXPECT_DOUBLE_EQ(derivative_by(0, number, {0.02, 0.03, 0.3}), 2.0);
  EXPECT_DOUBLE_EQ(derivative_by(1, number, {0.02, 0.03, 0.3}), 0.0);
}

TEST(Formula, HasTheUnitOfItsPlace) {
  EXPECT_EQ(complaint_with(section, "= 2*width + 1 kg"),
            "bad.json: /scene/bodies/crank/section/height has an error at column 11 of "
            "\"= 2*width + 1 kg\": units differ: a length [m] + a mass [kg]");
  EXPECT_EQ(complaint_with(section, "= width^2"),
            "bad.json: /scene/bodies/crank/section/height must be a length [m], got "
            "\"= width^2\", which is an area [m^2]");
  EXPECT_EQ(complaint_with(section, "= ratio"),
            "bad.json: /scene/bodies/crank/section/height must be a length [m], got \"= ratio\", "
            "which is a number without unit; give it its unit, as in \"5 mm\"");
}

/// A cycle is 2 pi rad: what to write for 10 Hz where an angular speed stands.
TEST(Formula, SaysHowCyclesBecomeAngles) {
  Json document = with_constants();
  document["constants"]["beat"] = "10 Hz";
  const Json::json_pointer speed("/scene/joints/bearing/drive/speed");
  ASSERT_TRUE(document.contains(speed));
  for (const char* formula : {"= beat", "= 2*pi*beat"}) {
    document[speed] = formula;
    EXPECT_THAT(complaint(document), testing::HasSubstr("write \"= f*1 rev\"")) << formula;
    EXPECT_THAT(complaint(document), testing::HasSubstr("\"= 2*pi*f*1 rad\"")) << formula;
  }
  for (const char* formula : {"= beat*1 rev", "= 2*pi*beat*1 rad"}) {
    document[speed] = formula;
    EXPECT_NO_THROW(read(document)) << formula;
  }
}

TEST(Formula, OfALoadCaseHasItsBracketClosed) {
  EXPECT_THAT(complaint_with(section, "= 2*width[slow"),
              testing::HasSubstr("at column 10 of \"= 2*width[slow\": the bracket [ of a load case "
                                 "is not closed; write \"name[case]\""));
}

TEST(Formula, WithoutItsSignIsGuessed) {
  EXPECT_THAT(complaint_with(section, "2*width"),
              testing::HasSubstr("with the sign at column 2 it looks like a formula, which begins "
                                 "with \"=\": \"= 2*width\""));
  EXPECT_THAT(complaint_with(section, "width + 1 mm"), testing::HasSubstr("at column 7"));
  EXPECT_THAT(complaint_with(section, "stroke"),
              testing::HasSubstr("a formula begins with \"=\": \"= stroke\""));
  EXPECT_THAT(complaint_with(section, "strike"), testing::Not(testing::HasSubstr("formula")));
}

TEST(Formula, KeepsToTheRangeOfItsPlaceAtAllBounds) {
  EXPECT_EQ(complaint_with(section, "= width - 1 cm"),
            "bad.json: /scene/bodies/crank/section/height must be positive [m], got "
            "\"= width - 1 cm\", which is -0.006, with the variable \"width\" at its lower bound");
  EXPECT_EQ(complaint_with(section, "= -stroke"),
            "bad.json: /scene/bodies/crank/section/height must be positive [m], got \"= -stroke\"");
}

TEST(Formula, NamesWhatItDoesNotKnow) {
  EXPECT_EQ(complaint_with(section, "= 2*widht"),
            "bad.json: /scene/bodies/crank/section/height has an error at column 5 of "
            "\"= 2*widht\": unknown name \"widht\"; did you mean \"width\"?");
}

TEST(Formula, WhereNoVariableCanStandIsFixed) {
  EXPECT_EQ(complaint_with("/simulation/step", "= width/(100 m/s)"),
            "bad.json: /simulation/step must be fixed here; a formula of design variables can "
            "stand for numbers of the scene, got \"= width/(100 m/s)\"");
}

TEST(Formula, TakesAVariableForWhatItsStartIsWrittenIn) {
  // The start of the diameter is a plain number, its upper bound has a unit.
  EXPECT_EQ(complaint_with(section, "= diameter"), "");
  Json document = edited("/variables/diameter", R"({"start": 0.03, "lower": 0.01, "upper": 0.06})");
  document[Json::json_pointer(section)] = "= diameter*1 m";
  EXPECT_EQ(complaint(document),
            "bad.json: /scene/bodies/crank/section/height takes the variable \"diameter\" for a "
            "number without unit, as its start is written, but "
            "/scene/bodies/rod/segments/0/section/outer_diameter uses it as a length [m]; give "
            "the start of the variable its unit");
}

TEST(Formula, GivesAVariableItsQuantityIfNothingElseDoes) {
  Json document = good_json();
  document["variables"]["thickness"] = {{"start", "2 mm"}, {"lower", "1 mm"}, {"upper", "3 mm"}};
  document["scene"]["bodies"]["rod"]["segments"][0]["section"]["thickness"] = "= thickness";
  const ProblemFile problem = read(document);
  EXPECT_EQ(variable_quantity(problem, 3), quantities::length);
  EXPECT_EQ(variable_units(problem)[3].name, "mm");
}

TEST(Constant, MayNotHaveANameThatIsTaken) {
  Json document = good_json();
  document["constants"] = {{"width", 3}};
  EXPECT_EQ(complaint(document), "bad.json: /constants/width has the name of a design variable");
  document["constants"] = {{"pi", 3}};
  EXPECT_EQ(complaint(document),
            "bad.json: /constants/pi has a name that is taken: pi is 3.14159…");
  document["constants"] = {{"stroke", "80 mmx"}};
  EXPECT_EQ(complaint(document),
            "bad.json: /constants/stroke must be a number, a text with unit, or a formula \"= …\", "
            "got \"80 mmx\": \"mmx\" is not a known unit; did you mean \"mm\"?");
}

Json with_response(const std::string& value) {
  Json document = with_constants();
  document["responses"]["formula"] = {{"type", "expression"}, {"value", value}};
  return document;
}

const ResponseSettings& formula_of(const ProblemFile& problem) {
  return find_response(problem, "formula");
}

TEST(ExpressionResponse, HasTheUnitThatItsFormulaHas) {
  const ProblemFile problem = read(with_response("weight*9.81 m/s^2*place + bow*3 N"));
  EXPECT_EQ(quantity_of(formula_of(problem)).unit, "N m");
  EXPECT_EQ(unit_of(read(with_response("bow/place")).responses.back()).name, "1");
  EXPECT_EQ(unit_of(formula_of(read(with_response("place - 2*bow")))).name, "mm");
}

TEST(ExpressionResponse, IsShownInTheUnitThatIsAskedFor) {
  Json document = with_response("weight*9.81 m/s^2*place");
  document["responses"]["formula"]["unit"] = "N mm";
  const ProblemFile problem = read(document);
  EXPECT_EQ(unit_of(formula_of(problem)).name, "N mm");
  EXPECT_DOUBLE_EQ(unit_of(formula_of(problem)).shown(3.0), 3000.0);
  document["responses"]["formula"]["unit"] = "kg";
  EXPECT_EQ(complaint(document),
            "bad.json: /responses/formula/unit must be a unit of a torque [N m], which the formula "
            "is, got \"kg\": \"kg\" measures something else");
}

TEST(ExpressionResponse, NamesResponsesBeforeAndBehindIt) {
  Json document = with_response("bow + place");
  document["responses"]["later"] = {{"type", "expression"}, {"value", "2*formula - 'end x'"}};
  document["responses"]["end x"] = document["responses"]["place"];
  EXPECT_EQ(complaint(document), "");
  document["responses"]["formula"]["value"] = "bow + later";
  EXPECT_NE(complaint(document).find("/responses/formula/value has an error at column 7"),
            std::string::npos);
}

TEST(ExpressionResponse, OfFrequenciesTakesLimitsInHertz) {
  Json document = with_response("f2 - f1");
  document["responses"]["f1"] = {{"type", "frequency"}, {"body", "rod"}};
  document["responses"]["f2"] = {{"type", "frequency"}, {"body", "rod"}, {"mode", 2}};
  document["constraints"]["gap"] = {{"response", "formula"}, {"lower", "20 Hz"}};
  const ProblemFile problem = read(document);
  EXPECT_NEAR(*problem.constraints.back().lower, 125.66370614359172, 1e-12);  // 40 π
  EXPECT_EQ(unit_of(formula_of(problem)).name, "Hz");
}

TEST(ExpressionResponse, DependsOnSomething) {
  EXPECT_EQ(complaint(with_response("2*stroke")),
            "bad.json: /responses/formula/value must depend on a response or on a design variable, "
            "got \"2*stroke\"");
  Json document = with_response("bow");
  document["responses"]["formula"]["over_time"] = "max";
  EXPECT_NE(complaint(document).find("is not for an expression"), std::string::npos);
}

TEST(ExpressionResponse, WithANameOfTwoThingsIsRefused) {
  Json document = with_response("width*2");
  EXPECT_EQ(complaint(document), "");
  document["responses"]["width"] = {{"type", "mass"}};
  EXPECT_NE(complaint(document).find("stands for two things"), std::string::npos);
}

TEST(Goal, MayBeAFormula) {
  Json document = with_constants();
  document["objective"] = {{"maximize", "= place - 2*bow"}};
  document["constraints"]["slenderness"] = {{"response", "= diameter/width"}, {"upper", "= ratio"}};
  document["constraints"]["again"] = {{"response", "= diameter/width"}, {"lower", 0.1}};
  const ProblemFile problem = read(document);
  EXPECT_EQ(problem.objective->response, "place - 2*bow");
  EXPECT_EQ(problem.objective->aim, Aim::maximize);
  ASSERT_EQ(problem.responses.size(), 7U);  // two formulas, of which one is used twice
  EXPECT_EQ(problem.responses.back().name, "diameter/width");
  EXPECT_DOUBLE_EQ(*problem.constraints[4].upper, 2.5);
}

TEST(Goal, ThatIsOneNameIsThatResponseOrThatVariable) {
  Json document = with_constants();
  document["objective"] = {{"minimize", "= bow"}};
  document["constraints"]["slenderness"] = {{"response", "= 2*bow"}, {"upper", "1 m"}};
  const std::size_t responses = read(document).responses.size();
  EXPECT_EQ(read(document).objective->response, "bow");
  document["objective"] = {{"minimize", "bow"}};
  EXPECT_EQ(read(document).responses.size(), responses);
  document["objective"] = {{"minimize", "= width"}};
  document["constraints"]["slenderness"] = {{"response", "= diameter/width"}, {"upper", 9}};
  EXPECT_EQ(complaint(document), "");
  EXPECT_EQ(read(document).objective->response, "(width)");
  document["objective"] = {{"minimize", "= max(width, 2*diameter)"}};
  EXPECT_EQ(complaint(document), "");
  document["objective"] = {{"minimize", "= 1*width"}};
  EXPECT_EQ(complaint(document), "");
}

TEST(Goal, IsEitherSmallOrLarge) {
  Json document = good_json();
  document["objective"]["maximize"] = "weight";
  EXPECT_EQ(complaint(document), "bad.json: /objective has both \"minimize\" and \"maximize\"");
}

}  // namespace
}  // namespace pleuel::test::formula_test
