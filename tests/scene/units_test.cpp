#include "core/scene/units.hpp"

#include <map>

#include "core/scene/common_units.hpp"
#include "core/scene/dimension.hpp"
#include "core/scene/response_kind.hpp"
#include "core/scene/shown_unit.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::units_test {
namespace {

/// What the reading of a text complains about; empty if it does not.
std::string complaint(const std::string& text, const Quantity& quantity) {
  return thrown<UnitError>([&] { read_quantity(text, quantity); });
}

struct Reading {
  std::string text;
  Quantity quantity;
  double value;  // SI, by the definition of the unit
};

class UnitReading : public testing::TestWithParam<Reading> {};

TEST_P(UnitReading, GivesTheValueInSi) {
  const Reading& reading = GetParam();
  // Conversion is one or two multiplications: a few units in the last place.
  EXPECT_NEAR(read_quantity(reading.text, reading.quantity), reading.value,
              1e-14 * std::abs(reading.value));
}

TEST(CommonUnits, AreWhatTheDatabaseSaysToTheLastBit) {
  for (const CommonUnit& common : common_units()) {
    const Quantity quantity{"a quantity", common.si};
    EXPECT_EQ(common.scale, scale_by_database(std::string(common.unit), quantity)) << common.unit;
  }
}

TEST(CommonUnits, MeasureWhatTheDatabaseSays) {
  for (const CommonUnit& common : common_units()) {
    const std::string name(common.unit);
    const MeasuredUnit known = measure_by_database(name), found = measure_unit(name);
    EXPECT_EQ(found.scale, known.scale) << name;
    EXPECT_EQ(found.dimension, known.dimension) << name;
  }
  EXPECT_EQ(find_common_unit("furlong"), nullptr);
}

TEST(CommonUnits, BelongToTheirQuantityOnly) {
  EXPECT_EQ(unit_scale("mm", quantities::length), 1e-3);
  EXPECT_THROW((void)unit_scale("mm", quantities::mass), UnitError);
}

using namespace quantities;
constexpr double pi = std::numbers::pi;

INSTANTIATE_TEST_SUITE_P(
    Units, UnitReading,
    testing::Values(Reading{"120 mm", length, 0.12}, Reading{"120mm", length, 0.12},
                    Reading{" +1.5e2 mm ", length, 0.15}, Reading{"-3 cm", length, -0.03},
                    Reading{".5 m", length, 0.5}, Reading{"1 in", length, 0.0254},
                    Reading{"5 \xC2\xB5m", length, 5e-6}, Reading{"0 mm", length, 0.0},
                    Reading{"5 nm", length, 5e-9}, Reading{"210 GPa", stress, 2.1e11},
                    Reading{"200 N/mm^2", stress, 2e8}, Reading{"200 N/mm2", stress, 2e8},
                    Reading{"200 N mm-2", stress, 2e8}, Reading{"7850 kg/m^3", density, 7850.0},
                    Reading{"7.85 g/cm^3", density, 7850.0},
                    Reading{"7850 kg/m\xC2\xB3", density, 7850.0}, Reading{"2 t", mass, 2000.0},
                    Reading{"1e-5 s", time, 1e-5}, Reading{"50 ms", time, 0.05},
                    Reading{"2 min", time, 120.0}, Reading{"2 1/s", rate, 2.0},
                    Reading{"2 Hz", rate, 2.0}, Reading{"2 kHz", frequency, 2000.0},
                    Reading{"2 1/s", frequency, 2.0}, Reading{"9.81 m/s^2", acceleration, 9.81},
                    Reading{"3 N m", torque, 3.0}, Reading{"3 Nm", torque, 3.0},
                    Reading{"3 J", torque, 3.0}, Reading{"4 kg m^2", inertia, 4.0},
                    Reading{"5 N m s", times_time(torque), 5.0},
                    Reading{"5 mm s", times_time(length), 0.005},
                    Reading{"5 MPa s", times_time(stress), 5e6}, Reading{"0.3", pure_number, 0.3},
                    Reading{"30 %", pure_number, 0.3}, Reading{"4096 B", data, 4096.0},
                    Reading{"1.5 kB", data, 1500.0}, Reading{"4 GB", data, 4e9},
                    Reading{"1 KiB", data, 1024.0}, Reading{"512 MiB", data, 536870912.0},
                    Reading{"2 GiB", data, 2147483648.0}, Reading{"10 PS", power, 7354.9875}),
    named_by(&Reading::text));

INSTANTIATE_TEST_SUITE_P(UnitsOfAngularSpeed, UnitReading,
                         testing::Values(Reading{"200 rad/s", angular_speed, 200.0},
                                         Reading{"1500 rpm", angular_speed, 50.0 * pi},
                                         Reading{"1500 rev/min", angular_speed, 50.0 * pi},
                                         Reading{"180 deg/s", angular_speed, pi},
                                         Reading{"180 degree/s", angular_speed, pi}),
                         named_by(&Reading::text));

/// Cycles and radians are both units of a frequency: one cycle is 2π rad.
INSTANTIATE_TEST_SUITE_P(UnitsOfFrequency, UnitReading,
                         testing::Values(Reading{"40 Hz", angular_frequency, 80.0 * pi},
                                         Reading{"2 kHz", angular_frequency, 4000.0 * pi},
                                         Reading{"40 rad/s", angular_frequency, 40.0},
                                         Reading{"60 rpm", angular_frequency, 2.0 * pi},
                                         Reading{"10 rad/s", frequency, 5.0 / pi},
                                         Reading{"60 rpm", frequency, 1.0}),
                         named_by(&Reading::text));

TEST(Units, OfAFrequencyAreNoTimesOrLengths) {
  EXPECT_EQ(complaint("3 m Hz", angular_frequency), "\"m Hz\" measures something else");
  EXPECT_EQ(complaint("3 rad", frequency), "\"rad\" measures something else");
  EXPECT_EQ(complaint("3 1/s", angular_frequency),
            "\"1/s\" names no angle; write rad/s, deg/s or rpm");
}

TEST(Units, OfAnotherQuantityAreRefused) {
  EXPECT_EQ(complaint("12 m/s", {"a quantity", "kg^0.5 m/s"}), "\"m/s\" measures something else");
  EXPECT_EQ(complaint("12 kg", length), "\"kg\" measures something else");
  EXPECT_EQ(complaint("12 mm^2", length), "\"mm^2\" measures something else");
  EXPECT_EQ(complaint("12 mm", pure_number), "\"mm\" measures something else");
  EXPECT_EQ(complaint("12 rad m", length), "\"rad m\" measures something else");
  EXPECT_EQ(complaint("12 rpm", rate), "\"rpm\" measures something else");
}

TEST(Units, WithoutAnAngleAreNoAngularSpeed) {  // 1500 1/min may be 25 rad/s or 157 rad/s
  EXPECT_EQ(complaint("25 Hz", angular_speed), "\"Hz\" names no angle; write rad/s, deg/s or rpm");
  EXPECT_EQ(complaint("1500 1/min", angular_speed),
            "\"1/min\" names no angle; write rad/s, deg/s or rpm");
}

TEST(Units, ThatAreUnknownAreRefused) {
  EXPECT_EQ(complaint("12 mmm", length), "\"mmm\" is not a known unit; did you mean \"mm\"?");
  EXPECT_EQ(complaint("12 Mpa", stress), "\"Mpa\" is not a known unit; did you mean \"MPa\"?");
  EXPECT_EQ(complaint("12 KG", mass), "\"KG\" is not a known unit; did you mean \"kg\"?");
  EXPECT_EQ(complaint("12 parrots", mass), "\"parrots\" is not a known unit");
  EXPECT_EQ(complaint("1,5 mm", length), "numbers have a decimal point, no comma; write 1.5 mm");
  EXPECT_EQ(complaint("0x10 mm", length), "\"x10 mm\" is not a known unit");
}

/// The database has them as short tons and megametres.
TEST(Units, ThatMeanTwoThingsAreRefused) {
  EXPECT_EQ(complaint("1 ton", mass),
            "\"ton\" is 907 kg to some and 1000 kg to others: write t for 1000 kg, or lb");
  EXPECT_EQ(complaint("28 Mm", length), "\"Mm\" is a thousand kilometres; write mm");
  EXPECT_THROW((void)measure_unit("tons/m"), UnitError);
}

TEST(Integrals, HaveAUnitForEveryResponse) {
  const auto expect_one = [](const AnyResponse& what) {
    const ResponseSettings response{"one", what, OverTime::integral};
    EXPECT_NO_THROW(quantity_of(response)) << kind_of(what).word;
  };
  for (const ResponseKind& kind : response_kinds()) {
    if (kind.word != "expression") expect_one(kind.made);  // that has the unit of its formula
  }
  for (const auto derivative :
       {TimeDerivative::none, TimeDerivative::first, TimeDerivative::second}) {
    expect_one(JointMotionResponse{"joint", DrivenCoordinate::displacement, derivative});
  }
  expect_one(SectionForceResponse{.part = SectionForcePart::torque});
}

TEST(Integrals, AreMeasuredInTheUnitOfTheResponseTimesASecond) {
  const Dimension second = measure_unit("s").dimension;
  for (const ResponseKind& kind : response_kinds()) {
    const MeasuredUnit unit = measure_unit(std::string(kind.quantity.unit));
    const MeasuredUnit integral = measure_unit(std::string(times_time(kind.quantity).unit));
    EXPECT_TRUE(integral.dimension == unit.dimension * second) << kind.word;
    EXPECT_DOUBLE_EQ(integral.scale, unit.scale) << kind.word;
  }
}

/// Several quantities have one unit, and several responses one quantity.
TEST(Integrals, AreCalledByTheQuantityThatUsuallyHasTheUnit) {
  EXPECT_EQ(describe(times_time(torque)), "a torque times a time [N m s]");
  EXPECT_EQ(describe(times_time(power)), "an energy [J]");
  EXPECT_EQ(describe(times_time(pure_number)), "a time [s]");
  EXPECT_EQ(describe(times_time(angular_frequency)), "an angular speed times a time [rad/s s]");
  EXPECT_EQ(
      describe(times_time(kind_of(TurningResponse{.derivative = TimeDerivative::second}).quantity)),
      "an angular acceleration times a time [rad/s^2 s]");
}

/// Formulas make roots of units, "sqrt(mass)", which others are made from: read back from their texts.
TEST(Units, MayHavePowersThatAreNotWhole) {
  Dimension dimension;
  dimension.powers = {0.5, 1.0 / 3.0, -1.5};
  const std::string text = base_units(dimension);
  EXPECT_EQ(text, "kg^0.3333 m^0.5/s^1.5");
  const MeasuredUnit found = measure_unit(text);
  EXPECT_TRUE(found.dimension == dimension);
  EXPECT_EQ(found.scale, 1.0);
  const Quantity root{"a quantity", "kg^0.5"};
  EXPECT_EQ(read_quantity("2 kg^0.5", root), 2.0);
  EXPECT_NE(complaint("2 m^0.5", root), "");
  EXPECT_NE(complaint("2 kg", root), "");
  EXPECT_NE(complaint("2 gnu^0.5", root), "");
}

TEST(Units, MayNotHideASecondNumber) {  // the library would read 30 mm, 0 m, −20 mm, …
  for (const char* text :
       {"1 mm 30", "1 000 mm", "120 mm -20", "1 mm*30", "1 mm.30", "1 m/2", "3 2/s", "1 mm + 2"}) {
    EXPECT_NE(complaint(text, std::string(text) == "3 2/s" ? rate : length), "") << text;
  }
}

TEST(Units, ThatDoNotCountFromZeroAreRefused) {
  EXPECT_NE(complaint("20 m from 3", length), "");
  EXPECT_NE(complaint("20 m @ 3", length), "");
}

TEST(Units, AreNeededInsideQuotes) {
  EXPECT_EQ(complaint("12", length), "a number in quotes needs its unit");
}

TEST(Numbers, MustBeFiniteAndComeFirst) {
  for (const char* text :
       {"", " ", "mm", "nan m", "inf m", "-inf m", "infinity", "+-1 m", "- 1 m"}) {
    EXPECT_EQ(complaint(text, length), "it does not begin with a number") << text;
  }
}

TEST(Numbers, MustBeInRange) {
  for (const char* text : {"1e400 m", "1e308 km", "1e-400 m", "1e-320 nm"}) {
    EXPECT_EQ(complaint(text, length), "it is out of the range of numbers") << text;
  }
}

TEST(Units, KeepWhatTheUserWrote) {
  const WrittenQuantity written = split_quantity("  -1.5e-3 kg/m^3 ");
  EXPECT_EQ(written.value, -1.5e-3);
  EXPECT_EQ(written.unit, "kg/m^3");
}

TEST(Units, ScaleBackForDisplay) {
  EXPECT_DOUBLE_EQ(0.12 / unit_scale("mm", length), 120.0);
}

// In which units people see responses.

/// A cantilever with limits that are written in different ways.
ProblemFile cantilever(const std::string& constraints) {
  return problem_from(R"json({
    "constants": {"most": "2 kN"},
    "scene": {
      "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
        "elements": 2, "section": {"type": "rectangle", "width": 0.02, "height": 0.02}}},
      "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}
    },
    "simulation": {"end_time": 0.01, "step": 0.001},
    "responses": {
      "force": {"type": "reaction-force", "joint": "wall", "direction": "y", "over_time": "max"},
      "stress": {"type": "stress", "body": "bar", "over_time": "max"},
      "speed": {"type": "velocity", "body": "bar", "at": 1, "direction": "y", "over_time": "max"},
      "ratio": {"type": "expression", "value": "force/1 kN"},
      "twice": {"type": "expression", "value": "2*force", "unit": "MN"},
      "first": {"type": "frequency"}
    },
    "constraints": )json" +
                      constraints + "}");
}

ShownUnit shown(const ProblemFile& problem, const std::string& response) {
  return unit_of(find_response(problem, response));
}

TEST(UnitOfAResponse, IsThatOfItsFirstLimit) {
  const ProblemFile problem = cantilever(R"json({
    "a": {"response": "force", "upper": "3 kN"}, "b": {"response": "force", "lower": "-5 N"},
    "c": {"response": "speed", "lower": "-20 mm/s", "upper": "1 m/s"},
    "d": {"response": "stress", "upper": "200 N/mm^2"},
    "e": {"response": "first", "lower": "60 rad/s"},
    "f": {"response": "= abs(force)", "upper": "3 kN"},
    "g": {"response": "ratio", "upper": "50 %"}})json");
  const std::map<std::string, std::pair<std::string, double>> expected = {
      {"force", {"kN", 1000.0}}, {"speed", {"m/s", 1.0}},        {"stress", {"N/mm^2", 1e6}},
      {"first", {"rad/s", 1.0}}, {"abs(force)", {"kN", 1000.0}}, {"ratio", {"%", 0.01}}};
  for (const auto& [response, unit] : expected) {
    EXPECT_EQ(shown(problem, response).name, unit.first);
    EXPECT_DOUBLE_EQ(shown(problem, response).factor, unit.second) << response;
  }
  EXPECT_EQ(shown(problem, "force").si, "N");
}

TEST(UnitOfAResponse, IsTheUsualOneWhereNoLimitHasOne) {
  const ProblemFile problem = cantilever(R"json({
    "a": {"response": "force", "upper": "= most"}, "b": {"response": "stress", "upper": 2e8}})json");
  EXPECT_EQ(shown(problem, "force").name, "N");
  EXPECT_EQ(shown(problem, "stress").name, "MPa");
  EXPECT_EQ(shown(problem, "first").name, "Hz");
}

TEST(UnitOfAResponse, IsWhatTheFileSays) {
  const ProblemFile problem =
      cantilever(R"json({"a": {"response": "twice", "upper": "3 kN"}})json");
  EXPECT_EQ(shown(problem, "twice").name, "MN");
}

}  // namespace
}  // namespace pleuel::test::units_test
