#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/time_breaks.hpp"
#include "core/trust/fast_laws.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/laws/law_problems.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::formula_law_test {
namespace {

/// A disc whose drive is a formula of t and of two variables, p and w, around 1. Its mass, of which
/// nothing asked depends, uses both.
ProblemFile disc_driven_by(const std::string& formula) {
  return problem_from(R"json({
  "scene": {
    "bodies": {"disc": {"type": "rigid", "at": [0, 0, 0], "mass": "= 2 kg*p*w/(1 rad/s)", "inertia": [1, 1, 1, 0, 0, 0]}},
    "joints": {"bearing": {"type": "revolute", "bodies": ["ground", "disc"], "at": [0, 0, 0],
      "drive": {"type": "expression", "value": ")json" +
                      formula + R"json("}}}},
  "simulation": {"end_time": 0.5, "step": 5e-3, "newton_tolerance": 1e-13},
  "variables": {"p": {"start": 1.3, "lower": 0.5, "upper": 2}, "w": {"start": "1.7 rad/s", "lower": 0.5, "upper": 4}},
  "responses": {"torque": {"type": "drive-torque", "joint": "bearing", "over_time": "rms"},
                "turn": {"type": "joint-position", "joint": "bearing", "over_time": "final"}},
  "objective": {"minimize": "torque"}
})json");
}

/// As a problem file has it.
std::string quoted(const std::string& formula) {
  return '"' + formula + '"';
}

template <class Scalar>
TimeLaw<Scalar> law_of(const ProblemFile& problem, const Design<Scalar>& design) {
  return resolve_time_law(problem.scene.joints[0].drive->motion, design, LawOf::motion);
}

/// All operations and functions, at places where they are smooth. Rates and accelerations against
/// differences of values and rates; design derivatives of all three against differences.
TEST(FormulaOfTime, HasItsExactDerivatives) {
  for (const char* formula :
       {"= 1 rad*(p*t/(1 s) + 2)^3 - 2 rad", "= 1 rad*sin(w*t)*cos(2*w*t)/p",
        "= 1 rad*exp(-p*t/(1 s))*tanh(t/(1 s))", "= 1 rad*log(1 + p*t/(1 s))*sqrt(2 + t/(1 s))",
        "= atan2(1 + p*t/(1 s), 2 - t/(1 s)) + atan(p*t/(1 s))",
        "= asin(0.3*p*t/(1 s)) + acos(0.5*t/(1 s))", "= 1 rad*tan(w*t)/(1 + t/(1 s))",
        "= 1 rad*(1.2 + t/(1 s))^(p*t/(1 s))",
        "= 1 rad*max(sin(w*t), p*t/(3 s)) - min(1 rad, abs(w*t))",
        "= 1 rad*p^(t/(1 s)) + 1 rad*(t/(1 s))^p"}) {
    const ProblemFile problem = disc_driven_by(formula);
    const Design<double> x = {1.3, 1.7};
    const TimeLaw<double> law = law_of(problem, x);
    for (const double time : {0.11, 0.23, 0.37}) {
      const auto at = [&](double h) { return law.at(time + h); };
      EXPECT_NEAR(at(0).rate, derivative_at_zero([&](double h) { return at(h).value; }, 1e-3),
                  1e-8 * (1.0 + std::abs(at(0).rate)))
          << formula;
      EXPECT_NEAR(at(0).acceleration,
                  derivative_at_zero([&](double h) { return at(h).rate; }, 1e-3),
                  1e-7 * (1.0 + std::abs(at(0).acceleration)))
          << formula;
      for (std::size_t variable = 0; variable < 2; ++variable) {
        Design<Dual> seeded(x.begin(), x.end());
        seeded[variable].derivatives()[0] = 1.0;
        const TimeValue<Dual> exact = law_of(problem, seeded).at(time);
        const auto shifted = [&](double h) {
          Design<double> moved = x;
          moved[variable] += h;
          const TimeValue<double> now = law_of(problem, moved).at(time);
          return Eigen::Vector3d(now.value, now.rate, now.acceleration);
        };
        const Eigen::Vector3d expected = derivative_at_zero(shifted, 1e-3);
        const Eigen::Vector3d found(derivative_of(exact.value), derivative_of(exact.rate),
                                    derivative_of(exact.acceleration));
        EXPECT_LE((found - expected).norm(), 1e-8 * (1.0 + expected.norm())) << formula;
      }
    }
  }
}

/// J φ̈ of a motion in closed form: J = 1 kg m², φ = p sin(w t).
TEST(FormulaOfTime, MovesADrive) {
  const auto [problem, x, analysis] = AtStart(disc_driven_by("= 1 rad*p*sin(w*t)"));
  EXPECT_NEAR(values_of(*analysis)(response_index(problem, "turn")), 1.3 * std::sin(0.85), 1e-9);
  // rms of p w² sin(w t) over 0.5 s
  const double square = 0.25 - std::sin(2 * 0.85) / (4 * 1.7);
  EXPECT_NEAR(values_of(*analysis)(response_index(problem, "torque")),
              1.3 * 1.7 * 1.7 * std::sqrt(square / 0.5), 1e-4);
}

/// By the laws that the house has had before.
TEST(FormulaOfTime, IsTheHarmonicLawThatItWritesOut) {
  const auto v = [](const std::string& value) { return value_at_start(pushed_block(value), "x"); };
  EXPECT_NEAR(
      v(quoted("= 2 N + 5 N*sin(40 rad/s*t + 0.3 rad)")),
      v(R"({"type": "harmonic", "amplitude": 5, "frequency": 40, "phase": 0.3, "offset": 2})"),
      1e-15);
  EXPECT_EQ(v(quoted("= 2 N + 5 N")), v("7"));
}

void expect_gradient_of_differences(const ProblemFile& problem) {
  const auto [direct, adjoint, expected] = law_gradients(problem);
  EXPECT_LE(relative_difference(adjoint, direct), 1e-10);
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    EXPECT_LE((direct.row(i) - expected.row(i)).norm(), 1e-6 * expected.row(i).norm()) << i;
  }
}

TEST(FormulaOfTime, HasTheGradientOfItsSimulation) {
  expect_gradient_of_differences(disc_driven_by("= 1 rad*p^2*sin(w*t)^3"));
  const ProblemFile beam =
      loaded_cantilever(quoted("= 1 N*force*(1 - cos(60 rad/s*t)) + 2 kN/m*height"),
                        {"/simulation/newton_tolerance=1e-13", "/variables/height/start=30 mm"});
  expect_gradient_of_differences(beam);
}

/// Where max and abs change sides, if that depends on time only.
TEST(FormulaWithKinks, HasInstantsThere) {
  const ProblemFile problem =
      pushed_block(quoted("= 6 N*max(0, sin(100 rad/s*t)) + abs(1 N - t*20 N/s)"));
  const std::vector<double> breaks = time_breaks(problem.scene, {0.1, 1e-3});
  const double pi = std::numbers::pi;
  for (const double time : {0.01 * pi, 0.02 * pi, 0.03 * pi, 0.05}) {
    EXPECT_TRUE(std::any_of(breaks.begin(), breaks.end(), [&](double one) {
      return std::abs(one - time) < 1e-12;
    })) << time;
  }
}

TEST(FormulaWithKinks, IsDoubtedAsADriveWhoseSpeedJumps) {
  const std::vector<Finding> findings =
      check_fast_laws_before(disc_driven_by("= abs(2 rad/s*t - 0.5 rad)"));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text, HasSubstr("its speed jumps at t = 0.25 s"));
  EXPECT_TRUE(check_fast_laws_before(disc_driven_by("= 2 rad/s*t + 0.5 rad")).empty());
  // A kink of a formula whose speed and acceleration go on.
  EXPECT_TRUE(check_fast_laws_before(disc_driven_by("= 1 rad*max(0, t/(1 s) - 0.0333)^3")).empty());
}

TEST(FormulaOfTime, IsAnsweredWithItsColumn) {
  const auto refusal = [](const std::string& value) -> std::string {
    return thrown<InputError>([&] { pushed_block(value); });
  };
  EXPECT_THAT(refusal(quoted("= 5 N*t")), HasSubstr("/scene/loads/push/value must be a force [N]"));
  EXPECT_THAT(refusal(quoted("= 5 N*sin(2*pi*t/(1 s))")), HasSubstr("needs an angle"));
  EXPECT_THAT(refusal(quoted("= 5 N*tau")), HasSubstr("column 7"));
  EXPECT_THAT(refusal(quoted("= 5 N/rad*angle")), HasSubstr("unknown name \"angle\""));
  EXPECT_THAT(refusal(R"({"type": "expression", "value": 5})"),
              HasSubstr("/scene/loads/push/value/value must be a formula"));
}

constexpr double pi = std::numbers::pi;

/// The law of the push on the block.
TimeLaw<double> load_law(const std::string& value) {
  const ProblemFile problem = pushed_block(value);
  return resolve_time_law(std::get<PointLoad>(problem.scene.loads[0].element).value,
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
  const ProblemFile problem = problem_from(with_drive(drive));
  return resolve_time_law(problem.scene.joints[0].drive->motion, Design<double>{}, LawOf::motion);
}

std::string refusal_of_drive(const std::string& drive) {
  return thrown<InputError>([&] { drive_law(drive); });
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
              HasSubstr(R"(/scene/joints/bearing/drive is missing the key "rise")"));
  EXPECT_THAT(refusal_of_drive(R"({"type": "ramp", "to": 1, "end": 1})"),
              HasSubstr(R"(/drive is missing the key "rounding")"));
  EXPECT_THAT(refusal_of_drive(R"({"type": "ramp", "to": 1, "end": 1, "rounding": 0.6})"),
              HasSubstr("/drive/rounding must be at most half of the duration, 0.5 s"));
  EXPECT_THAT(
      refusal_of_drive(R"({"type": "trapezoid", "value": 1, "rise": 0.1, "flanks": "straight"})"),
      HasSubstr("/drive/flanks must be \"smooth\" of a drive"));
  EXPECT_THAT(refusal_of_drive(R"({"type": "half-sine", "amplitude": 1, "duration": 1})"),
              HasSubstr("/drive/type must be"));
}

TEST(Period, MustCoverWhatIsRepeated) {
  const auto refusal = [](const std::string& value) -> std::string {
    return thrown<InputError>([&] { pushed_block(value); });
  };
  EXPECT_THAT(
      refusal(R"({"type": "table", "times": [0, 1], "values": [1, 2], "period": 0.5})"),
      HasSubstr("/scene/loads/push/value/period must be at least what the table covers, 1 s"));
  EXPECT_THAT(refusal(R"({"type": "table", "times": [0, 1], "values": [1, 2], "period": 1})"),
              HasSubstr("needs a last value that is the first"));
  EXPECT_THAT(
      refusal(R"({"type": "half-sine", "amplitude": 1, "duration": 1, "period": "900 ms"})"),
      HasSubstr("/period must be at least as long as what is repeated, 1 s"));
}

}  // namespace
}  // namespace pleuel::test::formula_law_test
