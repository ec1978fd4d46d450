#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/time_breaks.hpp"
#include "core/trust/fast_laws.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/laws/law_gradients.hpp"
#include "tests/laws/law_problems.hpp"
#include "tests/support/differences.hpp"

namespace pleuel::test::formula_law_test {
namespace {

/// A disc whose drive is a formula of t and of two variables, p and w, around 1. Its mass, of which
/// nothing asked depends, uses both.
ProblemFile disc_driven_by(const std::string& formula) {
  return read_problem_text(R"json({
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
})json",
                           "disc.json")
      .complete();
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
  const ProblemFile problem = disc_driven_by("= 1 rad*p*sin(w*t)");
  const auto analysis = analyze(problem, start_design(problem));
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
  EXPECT_THAT(findings[0].text, testing::HasSubstr("its speed jumps at t = 0.25 s"));
  EXPECT_TRUE(check_fast_laws_before(disc_driven_by("= 2 rad/s*t + 0.5 rad")).empty());
  // A kink of a formula whose speed and acceleration go on.
  EXPECT_TRUE(check_fast_laws_before(disc_driven_by("= 1 rad*max(0, t/(1 s) - 0.0333)^3")).empty());
}

TEST(FormulaOfTime, IsAnsweredWithItsColumn) {
  const auto refusal = [](const std::string& value) -> std::string {
    try {
      pushed_block(value);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal(quoted("= 5 N*t")),
              testing::HasSubstr("/scene/loads/push/value must be a force [N]"));
  EXPECT_THAT(refusal(quoted("= 5 N*sin(2*pi*t/(1 s))")), testing::HasSubstr("needs an angle"));
  EXPECT_THAT(refusal(quoted("= 5 N*tau")), testing::HasSubstr("column 7"));
  EXPECT_THAT(refusal(quoted("= 5 N/rad*angle")), testing::HasSubstr("unknown name \"angle\""));
  EXPECT_THAT(refusal(R"({"type": "expression", "value": 5})"),
              testing::HasSubstr("/scene/loads/push/value/value must be a formula"));
}

}  // namespace
}  // namespace pleuel::test::formula_law_test
