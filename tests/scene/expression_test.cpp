#include "core/base/expression.hpp"

#include <complex>
#include <limits>

#include "core/scene/reading/expression_parser.hpp"
#include "core/scene/shown_unit.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::expression_test {
namespace {

using Kind = ExpressionArgument::Kind;

Dimension dimension(const std::string& unit) {
  return measure_unit(unit).dimension;
}

/// a, b, c without unit; lengths p and q; a mass; a constant; a name that is no word.
std::vector<Symbol> symbols() {
  const auto argument = [](std::size_t i) { return ExpressionArgument{Kind::variable, i}; };
  return {{"a", {}, {}, argument(0)},
          {"b", {}, {}, argument(1)},
          {"c", {}, {}, argument(2)},
          {"p", dimension("m"), {}, argument(3)},
          {"q", dimension("m"), {}, argument(4)},
          {"load", dimension("kg"), {}, argument(5)},
          {"stroke", dimension("m"), 0.08, {}},
          {"tip deflection", dimension("m"), {}, argument(6)},
          {"f", dimension("rad/s"), {}, argument(7)},
          {"beat", dimension("Hz"), 60.0, {}, true},
          {"rate", dimension("s^-1"), 3.0, {}},
          {"t", dimension("s"), {}, argument(8)}};
}

constexpr double values[] = {0.7, 1.3, 0.4, 0.12, 0.35, 2.5, 0.003, 40.0, 0.01};

std::vector<double> arguments_of(const Expression& expression) {
  std::vector<double> arguments;
  for (const ExpressionArgument& argument : expression.arguments) {
    arguments.push_back(values[argument.index]);
  }
  return arguments;
}

double value_of(const std::string& text) {
  const ReadExpression read = read_expression(text, symbols());
  return evaluate(*read.expression, arguments_of(*read.expression)).value;
}

std::string unit_of(const std::string& text) {
  return read_expression(text, symbols()).expression->unit;
}

/// "column: what"; empty if the text can be read.
std::string complaint_about_formula(const std::string& text) {
  try {
    read_expression(text, symbols());
  } catch (const ExpressionError& error) {
    return std::to_string(error.column()) + ": " + error.what();
  }
  return "";
}

/// f is 40 rad/s, or 6.37 cycles a second: over 60 cycles that is 0.106, and over 60 Hz it would be
/// an angle of 0.667.
TEST(Expression, TakesNoAngleForARatioOfFrequencies) {
  for (const char* text : {"f/(60 Hz)", "f/beat", "f^2/(60 Hz)^2", "(60 Hz)/f", "f*(1/beat)"}) {
    EXPECT_NE(complaint_about_formula(text).find("write \"rev/s\" in place of \"Hz\""),
              std::string::npos)
        << text;
  }
  EXPECT_NEAR(value_of("f/(60 rev/s)"), 40.0 / (2.0 * std::numbers::pi * 60.0), 1e-15);
  // Angles, of which nobody thinks as of ratios; a decay rate has no cycles.
  EXPECT_DOUBLE_EQ(value_of("f*(2 s)"), 80.0);
  EXPECT_DOUBLE_EQ(value_of("f/rate"), 40.0 / 3.0);
  EXPECT_DOUBLE_EQ(value_of("f/(10 s^-1)"), 4.0);
  for (const char* text :
       {"sin(2*pi*beat*t*1 rad)", "sin(2*pi*beat*1 rad*t)", "sin(beat*1 rev*t)"}) {
    EXPECT_NEAR(value_of(text), std::sin(2.0 * std::numbers::pi * 0.6), 1e-12) << text;
  }
}

/// What is equal but for its round-off is a tie, with the mean of both derivatives.
TEST(Expression, HasTheMeanDerivativeWhereTwoAreEqualButForRoundOff) {
  const ReadExpression read = read_expression("min(a, b)", symbols());
  for (const double part : {0.0, 1e-15, -1e-15}) {
    const ExpressionValue found = evaluate(*read.expression, {1.3, 1.3 * (1.0 + part)});
    EXPECT_EQ(found.derivatives, (std::vector<double>{0.5, 0.5})) << part;
  }
  EXPECT_EQ(evaluate(*read.expression, {1.3, 1.3 * (1.0 + 1e-9)}).derivatives,
            (std::vector<double>{1.0, 0.0}));
  const ExpressionValue bounded =
      evaluate(*read.expression, {std::numeric_limits<double>::infinity(), 1.3});
  EXPECT_EQ(bounded.value, 1.3);
  EXPECT_EQ(bounded.derivatives, (std::vector<double>{0.0, 1.0}));
}

TEST(Expression, FollowsTheUsualPrecedence) {
  EXPECT_DOUBLE_EQ(value_of("1 + 2*3^2"), 19.0);
  EXPECT_DOUBLE_EQ(value_of("-2^2"), -4.0);
  EXPECT_DOUBLE_EQ(value_of("2^3^2"), 512.0);  // from the right
  EXPECT_DOUBLE_EQ(value_of("2^-1"), 0.5);
  EXPECT_DOUBLE_EQ(value_of("8/4/2"), 1.0);
  EXPECT_DOUBLE_EQ(value_of("8 - 4 - 2"), 2.0);
  EXPECT_DOUBLE_EQ(value_of("(1 + 2)*-(3)"), -9.0);
  EXPECT_DOUBLE_EQ(value_of("= a + b"), 2.0);
}

TEST(Expression, IsInSiWhateverUnitsItIsWrittenIn) {
  EXPECT_DOUBLE_EQ(value_of("p + 1 mm"), 0.121);
  EXPECT_EQ(unit_of("p + 1 mm"), "m");
  EXPECT_DOUBLE_EQ(value_of("2*stroke"), 0.16);
  EXPECT_DOUBLE_EQ(value_of("7.85 g/cm^3 * p*q^2"), 7850 * 0.12 * 0.35 * 0.35);
  EXPECT_EQ(unit_of("7.85 g/cm^3 * p*q^2"), "kg");
  EXPECT_DOUBLE_EQ(value_of("80 mm/2"), 0.04);  // a number after "/" ends the unit
  EXPECT_DOUBLE_EQ(value_of("3 N m/p"), 25.0);
  EXPECT_DOUBLE_EQ(value_of("2 m ^ 2"), 2.0);  // two square metres, whatever the blanks
  EXPECT_EQ(unit_of("load * 9.81 m/s^2"), "N");
  EXPECT_EQ(unit_of("load*p"), "kg m");
  EXPECT_EQ(unit_of("1/(load*p)"), "1/kg/m");
  EXPECT_DOUBLE_EQ(value_of("3000 rpm"), 100 * std::numbers::pi);
}

TEST(Expression, TakesUnitsThroughRootsAndPowers) {
  EXPECT_EQ(unit_of("sqrt(p^2 + q^2)"), "m");
  EXPECT_EQ(unit_of("sqrt(210 GPa/(7850 kg/m^3))"), "m/s");
  EXPECT_EQ(unit_of("(p*q)^0.5"), "m");
  EXPECT_EQ(unit_of("atan2(p, q)"), "rad");
  EXPECT_EQ(unit_of("p/q"), "1");
}

TEST(Expression, HasFunctionsOfAnglesWithUnits) {
  EXPECT_NEAR(value_of("sin(30 deg)"), 0.5, 1e-15);
  EXPECT_NEAR(value_of("cos(pi rad/3)"), 0.5, 1e-15);
  EXPECT_NEAR(value_of("tan(atan2(p, q))"), 0.12 / 0.35, 1e-15);
  EXPECT_NEAR(value_of("acos(cos(a*1 rad)) + asin(0) + atan(0)"), 0.7, 1e-15);
}

TEST(Expression, TakesTheSmallestAndTheLargestOfSeveral) {
  EXPECT_DOUBLE_EQ(value_of("max(p, q, 1 cm)"), 0.35);
  EXPECT_DOUBLE_EQ(value_of("min(p, q, 1 cm)"), 0.01);
  EXPECT_DOUBLE_EQ(value_of("abs(p - q)"), 0.23);
  EXPECT_DOUBLE_EQ(value_of("max(0, p - q)"), 0.0);  // 0 is no length as well
}

TEST(Expression, QuotesNamesThatAreNoWords) {
  EXPECT_DOUBLE_EQ(value_of("2*'tip deflection'"), 0.006);
}

TEST(Expression, KnowsWhatIsFixed) {
  EXPECT_TRUE(read_expression("2*stroke^2/(1 mm)", symbols()).constant.has_value());
  EXPECT_FALSE(read_expression("2*p", symbols()).constant.has_value());
}

using C = std::complex<double>;

/// The same formula in C++ for the complex step; functions of angles take plain numbers there.
struct Formula {
  const char* text;
  C (*by_hand)(C a, C b, C c);
};

/// By i·h with h = 1e-30: exact to round-off, and computed by the standard library.
std::vector<double> complex_step_gradient(const Formula& formula) {
  constexpr double h = 1e-30;
  const auto part = [&](int j) {
    const auto moved = [&](int i) { return C(values[i], i == j ? h : 0.0); };
    return formula.by_hand(moved(0), moved(1), moved(2)).imag() / h;
  };
  return {part(0), part(1), part(2)};
}

class ExpressionDerivative : public testing::TestWithParam<Formula> {};

TEST_P(ExpressionDerivative, EqualsTheComplexStep) {
  const ReadExpression read = read_expression(GetParam().text, symbols());
  const ExpressionValue found = evaluate(*read.expression, arguments_of(*read.expression));
  const std::vector<double> expected = complex_step_gradient(GetParam());
  std::vector<double> derivatives(3, 0.0);
  for (std::size_t i = 0; i < found.derivatives.size(); ++i) {
    derivatives[read.expression->arguments[i].index] = found.derivatives[i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(derivatives[i], expected[i], 1e-13 * (1.0 + std::abs(expected[i]))) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Formulas, ExpressionDerivative,
    testing::Values(
        Formula{"a*b + c^2/a - sqrt(a*b)",
                [](C a, C b, C c) { return a * b + c * c / a - std::sqrt(a * b); }},
        Formula{"a^b", [](C a, C b, C) { return std::pow(a, b); }},
        Formula{"2^-a*b", [](C a, C b, C) { return std::pow(2.0, -a) * b; }},
        Formula{"-a^2 + b*-c", [](C a, C b, C c) { return -(a * a) - b * c; }},
        Formula{"a/(b + c/(1 + a))", [](C a, C b, C c) { return a / (b + c / (1.0 + a)); }},
        Formula{"(a + b)^3*(a - c)^-2",
                [](C a, C b, C c) { return std::pow(a + b, 3) / ((a - c) * (a - c)); }},
        Formula{"exp(-a*b)*log(c) + tanh(a - b)",
                [](C a, C b, C c) { return std::exp(-a * b) * std::log(c) + std::tanh(a - b); }},
        Formula{"a^b^c/2/b", [](C a, C b, C c) { return std::pow(a, std::pow(b, c)) / 2.0 / b; }},
        Formula{"sin(a*1 rad)*cos(b*2 rad) + tan(a*c*1 rad)",
                [](C a, C b, C c) { return std::sin(a) * std::cos(2.0 * b) + std::tan(a * c); }}),
    named_by(&Formula::text));

/// Of functions that are not analytic; differences of second order with 1e-5, whose error is
/// below 1e-9 for numbers near 1.
TEST(ExpressionDerivativeOfKinks, EqualsDifferencesAwayFromThem) {
  for (const char* text :
       {"atan2(a, b)/(1 rad)*c", "asin(a*c)/(1 rad)", "acos(a*c)/(1 rad)", "atan(a/c)/(1 rad)",
        "max(a*b, c)", "min(a*b, c)", "max(a, b, c)*min(a, b)", "abs(c - a)", "abs(a - c)^3"}) {
    const ReadExpression read = read_expression(text, symbols());
    const std::vector<double> at = arguments_of(*read.expression);
    const ExpressionValue found = evaluate(*read.expression, at);
    for (std::size_t i = 0; i < at.size(); ++i) {
      constexpr double step = 1e-5;
      std::vector<double> above = at, below = at;
      above[i] += step;
      below[i] -= step;
      const double difference =
          (evaluate(*read.expression, above).value - evaluate(*read.expression, below).value) /
          (2 * step);
      EXPECT_NEAR(found.derivatives[i], difference, 1e-8) << text << " by argument " << i;
    }
  }
}

TEST(ExpressionDerivativeOfKinks, IsTheMeanOfBothSidesAtAKink) {
  const ReadExpression largest = read_expression("max(a, b)", symbols());
  EXPECT_EQ(evaluate(*largest.expression, {1.0, 1.0}).derivatives, (std::vector<double>{0.5, 0.5}));
  const ReadExpression magnitude = read_expression("abs(a)", symbols());
  EXPECT_EQ(evaluate(*magnitude.expression, {0.0}).derivatives, std::vector<double>{0.0});
}

TEST(Expression, WithoutValueIsNotFinite) {
  const ReadExpression root = read_expression("sqrt(a - b)", symbols());
  EXPECT_FALSE(std::isfinite(evaluate(*root.expression, {1.0, 2.0}).value));
  const ReadExpression ratio = read_expression("a/b", symbols());
  EXPECT_FALSE(std::isfinite(evaluate(*ratio.expression, {1.0, 0.0}).value));
}

/// A wrong text, the column where it is wrong, and words of what is said.
struct WrongFormula {
  const char* text;
  int column;
  const char* says;
};

class WrongUnit : public testing::TestWithParam<WrongFormula> {};

TEST_P(WrongUnit, IsNamedAtItsColumn) {
  const std::string said = complaint_about_formula(GetParam().text);
  EXPECT_EQ(said.substr(0, said.find(':')), std::to_string(GetParam().column)) << said;
  EXPECT_NE(said.find(GetParam().says), std::string::npos) << said;
}

INSTANTIATE_TEST_SUITE_P(
    InTwentyWays, WrongUnit,
    testing::Values(WrongFormula{"p + load", 3, "a length [m] + a mass [kg]"},
                    WrongFormula{"= p - 3 kg", 5, "a length [m] - a mass [kg]"},
                    WrongFormula{"2*p + 1", 5, "here a number needs its unit"},
                    WrongFormula{"1 + p", 3, "a number without unit + a length [m]"},
                    WrongFormula{"p*q + p", 5, "an area [m^2] + a length [m]"},
                    WrongFormula{"p^2 - p", 5, "an area [m^2] - a length [m]"},
                    WrongFormula{"sqrt(p) + p", 9, "a quantity [m^0.5] + a length [m]"},
                    WrongFormula{"max(p, load)", 1, "a length [m] compared with a mass [kg]"},
                    WrongFormula{"p + min(q, 2)", 5, "compared with a number without unit"},
                    WrongFormula{"a + atan2(p, load)", 5, "a length [m] over a mass [kg]"},
                    WrongFormula{"sin(30)", 1, "needs an angle, got a number without unit"},
                    WrongFormula{"a*cos(p)", 3, "needs an angle, got a length [m]"},
                    WrongFormula{"sin(pi/2)", 1, "\"pi rad\""},
                    WrongFormula{"asin(p)", 1, "needs a number without unit, got a length [m]"},
                    WrongFormula{"a^p", 2, "an exponent has no unit, got a length [m]"},
                    WrongFormula{"p^a", 2, "the exponent of a length [m] must be a fixed number"},
                    WrongFormula{"3 rad + a", 7, "angles never come or go silently"},
                    WrongFormula{"10 Hz - 3 rad/s", 7, "a cycle is 1 rev"},
                    WrongFormula{"atan2(p, q) + 1", 13, "angles never come or go silently"},
                    WrongFormula{"p + 5 foo", 7, "\"foo\" is not a known unit"},
                    WrongFormula{"p + 20 °C", 8, "does not count from zero"},
                    WrongFormula{"5 N*m", 5, "stands right behind its number"},
                    WrongFormula{"'tip deflection' + load", 18, "a length [m] + a mass [kg]"}),
    named_by(&WrongFormula::text));

INSTANTIATE_TEST_SUITE_P(
    OtherMistakes, WrongUnit,
    testing::Values(WrongFormula{"2 p", 3, "a product needs its *"},
                    WrongFormula{"strok + p", 1, "did you mean \"stroke\"?"},
                    WrongFormula{"p + 'tip deflektion'", 5, "did you mean \"tip deflection\"?"},
                    WrongFormula{"sine(3 rad)", 1, "did you mean \"sin\"?"},
                    WrongFormula{"p(2)", 1, "a product needs its *"},
                    WrongFormula{"(p + q", 7, "a bracket is not closed"},
                    WrongFormula{"p + q)", 6, "a bracket too many"},
                    WrongFormula{"2*", 3, "ends too early"}, WrongFormula{"=", 1, "no formula"},
                    WrongFormula{"p**2", 2, "\"^\", not \"**\""},
                    WrongFormula{"1,5*p", 2, "decimals have a point"},
                    WrongFormula{"1/0", 2, "no finite number"},
                    WrongFormula{"max(p)", 1, "two numbers at least"},
                    WrongFormula{"atan2(1, 2, 3)", 14, "too many arguments"},
                    WrongFormula{"atan2(1)", 8, "too few arguments"},
                    WrongFormula{"2*)", 3, "a number or a name is missing"},
                    WrongFormula{"p*/q", 3, "a number or a name is missing"},
                    WrongFormula{"sin()", 5, "a number or a name is missing"},
                    WrongFormula{"(a) (b)", 5, "a sign + - * / ^ is missing"},
                    WrongFormula{"(1,5)", 3, "decimals have a point"},
                    WrongFormula{"a + $", 5, "\"$\" is not understood here"},
                    WrongFormula{"p == 3 m", 3, "means nothing"},
                    WrongFormula{"p × q", 3, "is no sign of a formula"}),
    named_by(&WrongFormula::text));

/// The stack of the program has an end.
TEST(Expression, NestedTooDeeplyIsRefused) {
  EXPECT_DOUBLE_EQ(value_of(std::string(100, '(') + "a" + std::string(100, ')')), 0.7);
  for (const char* part : {"(", "-", "2^", "sin("}) {
    std::string text;
    for (int i = 0; i < 100000; ++i) text += part;
    EXPECT_NE(complaint_about_formula(text).find("nested deeper than 200"), std::string::npos)
        << part;
  }
}

TEST(Expression, RefusesAUnitThatMayBeAName) {
  std::vector<Symbol> all = symbols();
  all.push_back({"s", dimension("m"), {}, ExpressionArgument{Kind::variable, 0}});
  EXPECT_THROW(read_expression("80 mm/s", all), ExpressionError);
  EXPECT_EQ(read_expression("(80 mm)/s", all).expression->unit, "1");
  EXPECT_EQ(read_expression("80 mm s^-1", all).expression->unit, "m/s");
}

// Formulas in a problem file: in place of numbers, and as responses.

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
    EXPECT_THAT(complaint(document), HasSubstr("write \"= f*1 rev\"")) << formula;
    EXPECT_THAT(complaint(document), HasSubstr("\"= 2*pi*f*1 rad\"")) << formula;
  }
  for (const char* formula : {"= beat*1 rev", "= 2*pi*beat*1 rad"}) {
    document[speed] = formula;
    EXPECT_NO_THROW(read(document)) << formula;
  }
}

TEST(Formula, OfALoadCaseHasItsBracketClosed) {
  EXPECT_THAT(complaint_with(section, "= 2*width[slow"),
              HasSubstr("at column 10 of \"= 2*width[slow\": the bracket [ of a load case "
                        "is not closed; write \"name[case]\""));
}

TEST(Formula, WithoutItsSignIsGuessed) {
  EXPECT_THAT(complaint_with(section, "2*width"),
              HasSubstr("with the sign at column 2 it looks like a formula, which begins "
                        "with \"=\": \"= 2*width\""));
  EXPECT_THAT(complaint_with(section, "width + 1 mm"), HasSubstr("at column 7"));
  EXPECT_THAT(complaint_with(section, "stroke"),
              HasSubstr("a formula begins with \"=\": \"= stroke\""));
  EXPECT_THAT(complaint_with(section, "strike"), Not(HasSubstr("formula")));
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
  EXPECT_EQ(problem.variables[3].quantity, quantities::length);
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

const ResponseSettings& formula_in(const ProblemFile& problem) {
  return find_response(problem, "formula");
}

TEST(ExpressionResponse, HasTheUnitThatItsFormulaHas) {
  const ProblemFile problem = read(with_response("weight*9.81 m/s^2*place + bow*3 N"));
  EXPECT_EQ(quantity_of(formula_in(problem)).unit, "N m");
  EXPECT_EQ(unit_of(read(with_response("bow/place")).responses.back()).name, "1");
  EXPECT_EQ(unit_of(formula_in(read(with_response("place - 2*bow")))).name, "mm");
}

TEST(ExpressionResponse, IsShownInTheUnitThatIsAskedFor) {
  Json document = with_response("weight*9.81 m/s^2*place");
  document["responses"]["formula"]["unit"] = "N mm";
  const ProblemFile problem = read(document);
  EXPECT_EQ(unit_of(formula_in(problem)).name, "N mm");
  EXPECT_DOUBLE_EQ(unit_of(formula_in(problem)).shown(3.0), 3000.0);
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
  EXPECT_EQ(unit_of(formula_in(problem)).name, "Hz");
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
}  // namespace pleuel::test::expression_test
