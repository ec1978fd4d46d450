#include "core/base/expression.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/scene/reading/expression_parser.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::expression_test {
namespace {

using Kind = ExpressionArgument::Kind;

const UnitSystem& units() {
  static const UnitSystem system;
  return system;
}

Dimension dimension(const std::string& unit) {
  return units().measure(unit).dimension;
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
  const ReadExpression read = read_expression(text, symbols(), units());
  return evaluate(*read.expression, arguments_of(*read.expression)).value;
}

std::string unit_of(const std::string& text) {
  return read_expression(text, symbols(), units()).expression->unit;
}

/// "column: what"; empty if the text can be read.
std::string complaint(const std::string& text) {
  try {
    read_expression(text, symbols(), units());
  } catch (const ExpressionError& error) {
    return std::to_string(error.column()) + ": " + error.what();
  }
  return "";
}

/// f is 40 rad/s, or 6.37 cycles a second: over 60 cycles that is 0.106, and over 60 Hz it would be
/// an angle of 0.667.
TEST(Expression, TakesNoAngleForARatioOfFrequencies) {
  for (const char* text : {"f/(60 Hz)", "f/beat", "f^2/(60 Hz)^2", "(60 Hz)/f", "f*(1/beat)"}) {
    EXPECT_NE(complaint(text).find("write \"rev/s\" in place of \"Hz\""), std::string::npos)
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
  const ReadExpression read = read_expression("min(a, b)", symbols(), units());
  for (const double part : {0.0, 1e-15, -1e-15}) {
    const ExpressionValue found = evaluate(*read.expression, {1.3, 1.3 * (1.0 + part)});
    EXPECT_EQ(found.derivatives, (std::vector<double>{0.5, 0.5})) << part;
  }
  EXPECT_EQ(evaluate(*read.expression, {1.3, 1.3 * (1.0 + 1e-9)}).derivatives,
            (std::vector<double>{1.0, 0.0}));
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
  EXPECT_TRUE(read_expression("2*stroke^2/(1 mm)", symbols(), units()).constant.has_value());
  EXPECT_FALSE(read_expression("2*p", symbols(), units()).constant.has_value());
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
  const ReadExpression read = read_expression(GetParam().text, symbols(), units());
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
    const ReadExpression read = read_expression(text, symbols(), units());
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
  const ReadExpression largest = read_expression("max(a, b)", symbols(), units());
  EXPECT_EQ(evaluate(*largest.expression, {1.0, 1.0}).derivatives, (std::vector<double>{0.5, 0.5}));
  const ReadExpression magnitude = read_expression("abs(a)", symbols(), units());
  EXPECT_EQ(evaluate(*magnitude.expression, {0.0}).derivatives, std::vector<double>{0.0});
}

TEST(Expression, WithoutValueIsNotFinite) {
  const ReadExpression root = read_expression("sqrt(a - b)", symbols(), units());
  EXPECT_FALSE(std::isfinite(evaluate(*root.expression, {1.0, 2.0}).value));
  const ReadExpression ratio = read_expression("a/b", symbols(), units());
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
  const std::string said = complaint(GetParam().text);
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
    EXPECT_NE(complaint(text).find("nested deeper than 200"), std::string::npos) << part;
  }
}

TEST(Expression, RefusesAUnitThatMayBeAName) {
  std::vector<Symbol> all = symbols();
  all.push_back({"s", dimension("m"), {}, ExpressionArgument{Kind::variable, 0}});
  EXPECT_THROW(read_expression("80 mm/s", all, units()), ExpressionError);
  EXPECT_EQ(read_expression("(80 mm)/s", all, units()).expression->unit, "1");
  EXPECT_EQ(read_expression("80 mm s^-1", all, units()).expression->unit, "m/s");
}

}  // namespace
}  // namespace pleuel::test::expression_test
