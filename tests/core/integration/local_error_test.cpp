/// The size of the local error, of steps of one size and after a change of it, against the jerk of
/// a motion that is known: q = j t³/6.

#include "core/integration/simulate.hpp"
#include "core/model/model.hpp"
#include "tests/support/scheme_case.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::local_error_test {
namespace {

constexpr double jerk = 24.0, mass = 1.7;

/// A free mass that a force m j t pushes along x.
Model pushed_mass() {
  Scene scene;
  scene.bodies = {{"mass", PointMass{{0.3, 0.0, 0.0}, mass}}};
  scene.loads = {{"push", PointForce{"mass",
                                     {0.3, 0.0, 0.0},
                                     {1.0, 0.0, 0.0},
                                     PolynomialFunction{{0.0, mass * jerk}},
                                     false}}};
  return build_model(scene, {}, {}, {});
}

/// c of the error c h³ q⃛ of q in a step: Taylor's series of q⁺ = q + h v + h²(½ − β) w + h² β w⁺
/// with accelerations of the time δ h later gives β + δ/2 − 1/6. For generalized-α β = ¼ (1 − δ)²
/// and δ = −(1 − ρ)/(1 + ρ): 1/12 + δ²/4, from Newmark's 1/12 of the average acceleration (ρ = 1)
/// to 1/3 (ρ = 0).
double error_of_alpha(double radius) {
  const double delta = (1 - radius) / (1 + radius);
  return 1.0 / 12 + delta * delta / 4;
}

/// The same of Newmark's scheme with β = ¼ (1 + α)², γ = ½ + α.
double error_of_newmark(double radius) {
  const double alpha = (1 - radius) / (1 + radius);
  return 0.25 * (1 + alpha) * (1 + alpha) - 1.0 / 6;
}

/// What a step adds to q but for Taylor's series of the motion: the error that it makes [m].
double error_of_step(const Trajectory& trajectory, int step) {
  const double h = trajectory.time(step) - trajectory.time(step - 1);
  const auto last = step - 1;
  return trajectory.columns().q()(0, step) - trajectory.columns().q()(0, last) -
         h * trajectory.columns().v()(0, last) - h * h / 2 * trajectory.columns().a()(0, last) -
         h * h * h / 6 * jerk;
}

/// Instants with steps of 4, 4, 4, 1, 1, 2, 2, 2, 8, 8, 3, 3 ms.
std::vector<double> uneven_instants() {
  std::vector<double> instants = {0.0};
  for (const double step : {4, 4, 4, 1, 1, 2, 2, 2, 8, 8, 3, 3}) {
    instants.push_back(instants.back() + 1e-3 * step);
  }
  return instants;
}

class LocalError : public testing::TestWithParam<SchemeCase> {};

/// The same after a change of the step as before it. 1e-9: round-off of q over h³.
TEST_P(LocalError, IsThatOfTaylorsSeriesWhateverTheStepBefore) {
  Model model = pushed_mass();
  SimulationOptions options;
  GetParam().set(options);
  options.instants = uneven_instants();
  options.end_time = options.instants.back();
  options.step = 8e-3;
  const Trajectory trajectory = simulate(model.mechanism, options);
  ASSERT_EQ(trajectory.steps(), 12);
  const double radius = GetParam().spectral_radius;
  const double factor =
      GetParam().scheme == SchemeType::newmark ? error_of_newmark(radius) : error_of_alpha(radius);
  // The first steps still know that the acceleration before the start is none; the change after
  // the third forgets it.
  for (int step = 4; step <= 12; ++step) {
    const double h = options.instants[std::size_t(step)] - options.instants[std::size_t(step - 1)];
    EXPECT_NEAR(error_of_step(trajectory, step) / (factor * h * h * h * jerk), 1.0, 1e-5) << step;
    EXPECT_NEAR(trajectory.columns().a()(0, step), jerk * options.instants[std::size_t(step)],
                1e-9 * jerk);
  }
}

/// What control of the step and the start of index 3 take it for.
TEST_P(LocalError, IsWhatTheSchemeSaysOfIt) {
  const SchemeCase& of = GetParam();
  const double factor = of.scheme == SchemeType::newmark ? error_of_newmark(of.spectral_radius)
                                                         : error_of_alpha(of.spectral_radius);
  for (const double h : {1e-3, 0.2}) {
    EXPECT_NEAR(make_scheme(of.scheme, h, of.spectral_radius).local_error / (h * h * h), factor,
                1e-12);
    EXPECT_NEAR(make_restarting_scheme(of.scheme, h, of.spectral_radius).local_error / (h * h * h),
                factor, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Schemes, LocalError,
    testing::Values(SchemeCase{"Radius0", alpha, 0.0, index_3, 2.0},
                    SchemeCase{"Radius05", alpha, 0.5, index_3, 2.0},
                    SchemeCase{"Radius08", alpha, 0.8, index_3, 2.0},
                    SchemeCase{"Radius1", alpha, 1.0, index_3, 2.0},
                    SchemeCase{"Newmark", SchemeType::newmark, 1.0, index_3, 2.0},
                    SchemeCase{"DampedNewmark", SchemeType::newmark, 0.6, index_3, 1.0}),
    [](const auto& test) { return test.param.name; });

/// Newmark's velocity errs by (γ − ½) h² q⃛ in each step, after a change of the step, too; that of
/// generalized-α by nothing where the jerk is constant.
TEST(ErrorOfVelocity, IsThatOfTheTheoryAfterEveryChangeOfTheStep) {
  for (const SchemeCase& of :
       {SchemeCase{"", alpha, 0.5, index_3, 2.0}, SchemeCase{"", alpha, 0.0, index_3, 2.0},
        SchemeCase{"", SchemeType::newmark, 1.0, index_3, 2.0},
        SchemeCase{"", SchemeType::newmark, 0.6, index_3, 1.0}}) {
    Model model = pushed_mass();
    SimulationOptions options;
    of.set(options);
    options.instants = uneven_instants();
    options.end_time = options.instants.back();
    options.step = 8e-3;
    const Trajectory trajectory = simulate(model.mechanism, options);
    const double excess = of.scheme == SchemeType::newmark
                              ? (1 - of.spectral_radius) / (1 + of.spectral_radius)
                              : 0.0;
    for (int step = 4; step <= trajectory.steps(); ++step) {
      const double h = trajectory.time(step) - trajectory.time(step - 1);
      const double gained =
          trajectory.columns().v()(0, step) - trajectory.columns().v()(0, step - 1);
      const double exact = jerk * h * (trajectory.time(step - 1) + h / 2);
      EXPECT_NEAR(gained - exact, excess * h * h * jerk, 1e-9 * h * jerk) << step;
    }
  }
}

/// Steps are halved until the errors of one regular step, c h³ j each, add up to no more than the
/// tolerance [of the size of the mechanism]: 2ⁿ c (H/2ⁿ)³ j ≤ tolerance, and no further.
TEST(ControlledSteps, AreTheLongestThatKeepTheToleranceOfARegularStep) {
  constexpr double regular = 0.016;
  constexpr int count = 10;
  for (const double radius : {0.5, 0.8}) {
    Model model = pushed_mass();
    const double whole =
        error_of_alpha(radius) * std::pow(regular, 3) * jerk / model.mechanism.scale(0);
    for (const int halvings : {0, 1, 3}) {
      // Just allowed, and just not allowed: a quarter of it with every halving.
      for (const double share : {0.98, 1.02}) {
        SimulationOptions options{count * regular, regular, radius};
        options.formulation = stabilized;
        options.local_error = whole / share * std::pow(0.25, halvings);
        const Trajectory trajectory = simulate(model.mechanism, options);
        const int expected = halvings + (share < 1.0 ? 0 : 1);
        EXPECT_EQ(trajectory.steps(), count << expected) << radius << " " << halvings;
        EXPECT_EQ(trajectory.rejected_steps, expected);
      }
    }
  }
}

}  // namespace
}  // namespace pleuel::test::local_error_test
