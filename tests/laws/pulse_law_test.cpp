#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/time_breaks.hpp"
#include "tests/laws/law_problems.hpp"
#include "tests/support/differences.hpp"

namespace pleuel::test::pulse_law_test {
namespace {

constexpr double pi = std::numbers::pi;

/// The law of the push on the block.
TimeLaw<double> load_law(const std::string& value) {
  const ProblemFile problem = pushed_block(value);
  return resolve_time_law(std::get<PointForce>(problem.scene.loads[0].element).value,
                          Design<double>{});
}

std::string with_drive(const std::string& drive) {
  return R"({"scene": {
    "bodies": {"disc": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [1, 1, 1, 0, 0, 0]}},
    "joints": {"bearing": {"type": "revolute", "bodies": ["ground", "disc"], "at": [0, 0, 0], "drive": )" +
         drive + R"(}}},
  "simulation": {"end_time": 1, "step": 1e-2}})";
}

TimeLaw<double> drive_law(const std::string& drive) {
  const ProblemFile problem = read_problem_text(with_drive(drive), "disc.json").complete();
  return resolve_time_law(problem.scene.joints[0].drive->motion, Design<double>{}, LawOf::motion);
}

std::string refusal_of_drive(const std::string& drive) {
  try {
    drive_law(drive);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Rates and accelerations against differences of the value and of the rate, away from knots.
void expect_exact_rates(const TimeLaw<double>& law, std::initializer_list<double> times) {
  for (const double time : times) {
    const TimeValue<double> now = law.at(time);
    const double rate = derivative_at_zero([&](double h) { return law.at(time + h).value; }, 1e-4);
    const double acceleration =
        derivative_at_zero([&](double h) { return law.at(time + h).rate; }, 1e-4);
    EXPECT_NEAR(now.rate, rate, 1e-7 * (1.0 + std::abs(rate))) << time;
    EXPECT_NEAR(now.acceleration, acceleration, 1e-7 * (1.0 + std::abs(acceleration))) << time;
  }
}

TEST(StepLaw, JumpsAtItsTime) {
  const TimeLaw<double> law = load_law(R"({"type": "step", "from": 2, "to": 5, "time": 0.3})");
  EXPECT_EQ(law.at(0.2999).value, 2.0);
  EXPECT_EQ(law.at(0.3).value, 3.5);  // the mean of both sides
  EXPECT_EQ(law.at(0.3001).value, 5.0);
}

/// 10 s³ − 15 s⁴ + 6 s⁵: at a quarter of the rise 53/512.
TEST(StepLaw, RisesByTheQuinticThatRestsAtBothEnds) {
  const TimeLaw<double> law =
      drive_law(R"({"type": "step", "from": 2, "to": 4, "time": 0.3, "rise": 0.2})");
  EXPECT_EQ(law.at(0.2).value, 2.0);
  EXPECT_NEAR(law.at(0.35).value, 2.0 + 2.0 * 53.0 / 512.0, 1e-15);
  EXPECT_EQ(law.at(0.6).value, 4.0);
  for (const double end : {0.3 + 1e-12, 0.5 - 1e-12}) {
    EXPECT_NEAR(law.at(end).rate, 0.0, 1e-9);
    EXPECT_NEAR(law.at(end).acceleration, 0.0, 1e-7);
  }
  expect_exact_rates(law, {0.31, 0.4, 0.47});
}

/// The speed of a motion from 1 to 3 in 0.5 s whose ends are rounded within 0.1 s: 2/0.4, and within
/// the rounding 3s² − 2s³ of it.
TEST(RampLaw, HasTheSpeedOfItsRounding) {
  const TimeLaw<double> law = drive_law(
      R"({"type": "ramp", "from": 1, "to": 3, "begin": 0.2, "end": 0.7, "rounding": 0.1})");
  EXPECT_EQ(law.at(0.1).value, 1.0);
  EXPECT_NEAR(law.at(0.7).value, 3.0, 1e-15);
  EXPECT_NEAR(law.at(0.45).value, 2.0, 1e-14);  // half way in half the time
  for (const double s : {0.1, 0.25, 0.8}) {
    EXPECT_NEAR(law.at(0.2 + 0.1 * s).rate, 5.0 * s * s * (3.0 - 2.0 * s), 1e-12) << s;
    EXPECT_NEAR(law.at(0.7 - 0.1 * s).rate, 5.0 * s * s * (3.0 - 2.0 * s), 1e-12) << s;
  }
  EXPECT_NEAR(law.at(0.5).rate, 5.0, 1e-12);
  expect_exact_rates(law, {0.22, 0.5, 0.65});
}

TEST(RampLaw, MayBeRoundedAllTheWay) {
  const TimeLaw<double> law =
      drive_law(R"({"type": "ramp", "to": 3, "end": 0.4, "rounding": 0.2})");
  EXPECT_NEAR(law.at(0.2).value, 1.5, 1e-15);
  EXPECT_NEAR(law.at(0.2).rate, 15.0, 1e-12);
  expect_exact_rates(law, {0.1, 0.2, 0.33});
}

TEST(RampLaw, OfALoadIsStraight) {
  const TimeLaw<double> law = load_law(R"({"type": "ramp", "from": -1, "to": 3, "end": 0.4})");
  EXPECT_NEAR(law.at(0.1).value, 0.0, 1e-15);
  EXPECT_EQ(law.at(0.5).value, 3.0);
}

TEST(HalfSine, IsThatOfItsDuration) {
  const TimeLaw<double> law = load_law(
      R"({"type": "half-sine", "amplitude": 6, "offset": 1, "begin": 0.1, "duration": 0.2})");
  EXPECT_EQ(law.at(0.05).value, 1.0);
  EXPECT_EQ(law.at(0.35).value, 1.0);
  EXPECT_NEAR(law.at(0.14).value, 1.0 + 6.0 * std::sin(0.2 * pi), 1e-14);
  expect_exact_rates(law, {0.12, 0.2, 0.28});
}

TEST(Trapezoid, GoesUpHoldsAndGoesDown) {
  const std::string pulse =
      R"({"type": "trapezoid", "base": 1, "value": 5, "begin": 0.1, "rise": 0.1, "hold": 0.2, "fall": 0.4)";
  const TimeLaw<double> straight = load_law(pulse + "}"),
                        smooth = drive_law(pulse + R"(, "period": 1})");
  for (const auto& [time, value] :
       {std::pair(0.05, 1.0), {0.15, 3.0}, {0.3, 5.0}, {0.6, 3.0}, {0.9, 1.0}}) {
    EXPECT_NEAR(straight.at(time).value, value, 1e-14) << time;
    EXPECT_NEAR(smooth.at(time).value, value, 1e-14) << time;
    EXPECT_NEAR(smooth.at(time + 3.0).value, value, 1e-13) << time;
  }
  EXPECT_NEAR(straight.at(0.5).value, 4.0, 1e-14);
  expect_exact_rates(smooth, {0.12, 0.25, 0.5, 3.17});
}

TEST(PeriodicTable, IsTheSameAfterEachPeriod) {
  for (const char* interpolation : {"linear", "monotone", "spline", "step"}) {
    const TimeLaw<double> law = load_law(
        R"({"type": "table", "times": [0.1, 0.2, 0.25], "values": [1, 4, 2], "period": 0.5, "interpolation": ")" +
        std::string(interpolation) + "\"}");
    for (const double time : {0.11, 0.23, 0.31, 0.59}) {
      for (const double k : {-2.0, 1.0, 7.0}) {
        EXPECT_NEAR(law.at(time + 0.5 * k).value, law.at(time).value, 1e-12) << interpolation;
      }
    }
    EXPECT_NEAR(law.at(0.1 + 1e-9).value, 1.0, 1e-6) << interpolation;  // the first value again
  }
}

/// At a jump of any period the mean of both sides, though periods round.
TEST(PeriodicTable, HasTheMeanAtAllItsJumps) {
  const TimeLaw<double> law = load_law(
      R"({"type": "table", "times": [0, 0.03], "values": [4, 1], "period": 0.1, "interpolation": "step"})");
  for (int k = 1; k < 50; ++k) {
    EXPECT_EQ(law.at(0.0 + k * 0.1).value, 2.5) << k;
    EXPECT_EQ(law.at(0.03 + k * 0.1).value, 2.5) << k;
  }
  EXPECT_EQ(law.at(0.0).value, 4.0);  // from t = 0 on there is one side only
}

/// Twelve points a period of a cosine: a spline that knows its period errs by about
/// (2π/12)⁴/384 = 2e-4 everywhere, with two continuous derivatives.
TEST(PeriodicSpline, FollowsACosineAcrossItsEnds) {
  std::vector<double> knots, values;
  for (int i = 0; i <= 12; ++i) {
    knots.push_back(i / 12.0);
    values.push_back(std::cos(2.0 * pi * i / 12.0));
  }
  TimeLaw<double> law = cubic_spline(knots, values, TableEnds::periodic);
  law.period = 1.0;
  for (double time = -0.3; time < 1.4; time += 0.013) {
    EXPECT_NEAR(law.at(time).value, std::cos(2.0 * pi * time), 3e-4) << time;
  }
  const TimeValue<double> before = law.at(1.0 - 1e-10), after = law.at(1.0 + 1e-10);
  EXPECT_NEAR(before.rate, after.rate, 1e-7);
  EXPECT_NEAR(before.acceleration, after.acceleration, 1e-6);
}

/// A load is what its shape says: the impulse of a half sine is 2/π of amplitude times duration,
/// that of a trapezoid its area. Steps end at the corners; what is left is the second order of the
/// scheme, (h/T)² of the speed with the time T that the load acts.
TEST(Pulse, GivesItsImpulse) {
  const auto expect_speed = [](const std::string& value, double impulse, double duration) {
    const double speed = impulse / 2.0, share = 1e-3 / duration;
    EXPECT_NEAR(value_at_start(pushed_block(value), "v"), speed, share * share * speed) << value;
  };
  expect_speed(R"({"type": "half-sine", "amplitude": 6, "begin": 0.0213, "duration": 0.05})",
               6.0 * 0.05 * 2.0 / pi, 0.05);
  expect_speed(
      R"({"type": "trapezoid", "value": 6, "begin": 0.0213, "rise": 0.0112, "hold": 0.0311})",
      6.0 * (0.0112 + 0.0311), 0.0535);
  expect_speed(R"({"type": "step", "to": 6, "time": 0.0213})", 6.0 * (0.1 - 0.0213), 0.0787);
}

TEST(PeriodicPulse, HasAnInstantAtEachOfItsCorners) {
  const ProblemFile problem = pushed_block(
      R"({"type": "half-sine", "amplitude": 6, "begin": 0.011, "duration": 0.02, "period": 0.03})");
  const std::vector<double> breaks = time_breaks(problem.scene, {0.1, 1e-3});
  for (const double time : {0.011, 0.031, 0.041, 0.061, 0.071, 0.091}) {
    EXPECT_TRUE(std::any_of(breaks.begin(), breaks.end(), [&](double one) {
      return std::abs(one - time) < 1e-12;
    })) << time;
  }
}

TEST(Drive, RefusesWhatWouldMoveItInNoTime) {
  EXPECT_THAT(refusal_of_drive(R"({"type": "step", "to": 1})"),
              testing::HasSubstr(R"(/scene/joints/bearing/drive is missing the key "rise")"));
  EXPECT_THAT(refusal_of_drive(R"({"type": "ramp", "to": 1, "end": 1})"),
              testing::HasSubstr(R"(/drive is missing the key "rounding")"));
  EXPECT_THAT(refusal_of_drive(R"({"type": "ramp", "to": 1, "end": 1, "rounding": 0.6})"),
              testing::HasSubstr("/drive/rounding must be at most half of the duration, 0.5 s"));
  EXPECT_THAT(
      refusal_of_drive(R"({"type": "trapezoid", "value": 1, "rise": 0.1, "flanks": "straight"})"),
      testing::HasSubstr("/drive/flanks must be \"smooth\" of a drive"));
  EXPECT_THAT(refusal_of_drive(R"({"type": "half-sine", "amplitude": 1, "duration": 1})"),
              testing::HasSubstr("/drive/type must be"));
}

TEST(Period, MustCoverWhatIsRepeated) {
  const auto refusal = [](const std::string& value) -> std::string {
    try {
      pushed_block(value);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal(R"({"type": "table", "times": [0, 1], "values": [1, 2], "period": 0.5})"),
              testing::HasSubstr(
                  "/scene/loads/push/value/period must be at least what the table covers, 1 s"));
  EXPECT_THAT(refusal(R"({"type": "table", "times": [0, 1], "values": [1, 2], "period": 1})"),
              testing::HasSubstr("needs a last value that is the first"));
  EXPECT_THAT(
      refusal(R"({"type": "half-sine", "amplitude": 1, "duration": 1, "period": "900 ms"})"),
      testing::HasSubstr("/period must be at least as long as what is repeated, 1 s"));
}

}  // namespace
}  // namespace pleuel::test::pulse_law_test
