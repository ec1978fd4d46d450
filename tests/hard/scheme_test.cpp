#include <array>

#include <Eigen/LU>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/hard/hard_problems.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::scheme_test {
namespace {

// Settings at their ends: step, spectral radius, number of steps.

class SchemeHardCase : public HardCase {};
PLEUEL_WITH_EACH_FORMULATION(SchemeHardCase);

/// Twenty steps of each size from 1e-2 to 1e-8 s.
TEST_P(SchemeHardCase, NeedsNoMoreNewtonIterationsAsTheStepFalls) {
  double before = 1e300;
  for (const double h : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    const auto analysis = run("dead_centres", {step_of(h), end_of(20 * h)});
    const double now = analysis->trajectory.newton_iterations / 20.0;
    EXPECT_LE(now, before) << h;
    before = now;
  }
  EXPECT_LE(before, 1.15) << "one a step, and a second look every sixteenth";
}

/// Scaled rows and unknowns: no step is worse conditioned than another by more than a factor of
/// ten.
TEST_P(SchemeHardCase, HasStepMatricesWhoseConditionDoesNotKnowTheStep) {
  double least = 1e300, most = 0.0;
  for (const double h : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    const double now =
        run("dead_centres", {step_of(h), end_of(20 * h)})->trajectory.worst_condition;
    least = std::min(least, now);
    most = std::max(most, now);
  }
  EXPECT_LE(most, 10.0 * least) << most;
}

/// The crank bearing holds the centripetal force of crank and pin from the first instant on; within
/// twenty steps of at most a microsecond the mechanism hardly moves. What index 3 errs in its
/// multipliers is the round-off of its positions over h²: a tenth is left of them at 1e-8 s.
TEST_P(SchemeHardCase, LosesNoMoreOfItsReactionsThanRoundOffOverTheSquareOfTheStep) {
  const std::string response =
      R"(/responses/bearing={"type": "reaction-force", "joint": "bearing", "direction": "x", "over_time": "final"})";
  for (const double h : {1e-6, 1e-7, 1e-8}) {
    const auto analysis = run("dead_centres", {response, step_of(h), end_of(20 * h)});
    const Eigen::RowVectorXd force = history_of(*analysis, "bearing");
    // Measured 5e-5, 5e-4, 0.11.
    EXPECT_LE((force.array() / force(0) - 1.0).abs().maxCoeff(), 2.5e-4 + 5e-17 / (h * h)) << h;
  }
}

/// From the first step on: measured 2.4. With w₀ = a₀ and v₀ as it is, index 3 has 1.0, with 23
/// times the error at 0.125 ms.
TEST_P(SchemeHardCase, ErrsInItsFirstReactionsInTheSecondOrderOfTheStep) {
  const auto forces = [](double h) {
    return history_of(*run("dead_centres", {step_of(h), end_of(5e-3)}), "guide_force");
  };
  const double finest = 1e-3 / 128;
  const Eigen::RowVectorXd exact = forces(finest);
  std::vector<double> steps, errors;
  for (const int factor : {32, 16, 8}) {
    const Eigen::RowVectorXd found = forces(factor * finest);
    double error = 0.0;
    for (int i = 1; i <= 10; ++i) error = std::max(error, std::abs(found(i) - exact(i * factor)));
    steps.push_back(factor * finest);
    errors.push_back(error);
  }
  EXPECT_GE(observed_order(steps, errors), 1.9);
}

/// Below 1 the spectral radius changes the answer by no more than the scheme's error: measured 1.2
/// to 2.0 mm, and 1e-3 of the force.
TEST_P(SchemeHardCase, AnswersTheSameForEverySpectralRadiusBelowOne) {
  const RigidSliderCrank reference = steel_slider_crank(1.5);
  const double exact = reference.slider(reference.coasting_angle(40.0, 1.0));
  const double force = value_of(*run("dead_centres", {step_of(1e-4)}), "guide_force");
  for (const double radius : {0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95}) {
    const auto analysis =
        run("dead_centres", {fmt::format("/simulation/spectral_radius={:g}", radius)});
    EXPECT_NEAR(value_of(*analysis, "slider_end"), exact, 4e-3) << radius;
    EXPECT_NEAR(value_of(*analysis, "guide_force") / force, 1.0, 3e-3) << radius;
  }
}

/// With ρ∞ = 1 nothing damps what a step leaves in the multipliers of index 3: they swing with a
/// growing amplitude until Newton's method fails (known from theory: Cardona & Géradin 1989).
TEST(Index3, FailsInTheEndWithoutAnyDissipationAndSaysWhen) {
  const std::vector<std::string> overrides = {"/simulation/formulation=index-3",
                                              "/simulation/spectral_radius=1"};
  std::vector<std::string> longer = overrides;
  longer.push_back("/simulation/end_time=10");
  const ProblemFile problem = sample_problem("hard/dead_centres", longer);
  EXPECT_THAT(thrown<SimulationError>([&] { analyze(problem, start_design(problem)); }),
              HasSubstr("simulation stopped at t = "))
      << "index 3 without dissipation is unstable";
}

/// Largest violation of constraints in so many seconds of a coasting slider-crank.
double drift_of_index_1(double seconds, const std::vector<std::string>& more) {
  std::vector<std::string> overrides = {"/simulation/formulation=index-1", end_of(seconds)};
  overrides.insert(overrides.end(), more.begin(), more.end());
  const ProblemFile problem = sample_problem("hard/dead_centres", overrides);
  return largest_violation(*analyze(problem, start_design(problem)));
}

/// Constraints on accelerations only: what they err in adds up (measured: four times as much in
/// four times as long). Baumgarte's terms (1972) hold it at a level that does not depend on time.
TEST(Index1, DriftsAwayAndBaumgartesTermsHoldIt) {
  EXPECT_GE(drift_of_index_1(4.0, {}) / drift_of_index_1(1.0, {}), 3.5);
  const std::vector<std::string> baumgarte = {"/simulation/baumgarte=100"};
  EXPECT_LE(drift_of_index_1(4.0, baumgarte) / drift_of_index_1(1.0, baumgarte), 1.1);
}

/// A projection leaves round-off, however long it goes on: measured 3e-16 m after 1 s and 1e-15 m
/// after 4 s, where steps without it are off by 1.4e-4 and 5.5e-4 m.
TEST(Index1, KeepsItsConstraintsToRoundOffByProjection) {
  const std::vector<std::string> projection = {"/simulation/projection=true"};
  EXPECT_LE(drift_of_index_1(1.0, projection), 1e-14);
  EXPECT_LE(drift_of_index_1(4.0, projection), 1e-14);
}

/// It would go on with joints that are apart by the size of the mechanism. When they are by a
/// hundredth depends on what the first step sets out from: measured 9 s with the exact acceleration
/// and jerk, 39 s with those of a damped start.
TEST(Index1, StopsWhereTheBricardMechanismComesApartAndNamesTheJoint) {
  const ProblemFile problem =
      sample_problem("hard/bricard", {"/simulation/formulation=index-1", end_of(60.0)});
  EXPECT_THAT(thrown<SimulationError>([&] { analyze(problem, start_design(problem)); }),
              HasSubstr("have drifted, those of the joint \"hinge"))
      << "it drifts";
}

/// Matrix of one step of generalized-α (Chung & Hulbert 1993, in the form of Arnold & Brüls
/// 2007) on  q̈ + 2ζω q̇ + ω² q = 0,  state (q, v, w):
///     q⁺ = q + hv + h²(½−β) w + h²β w⁺,  v⁺ = v + h(1−γ) w + hγ w⁺,
///     (1−α_m) w⁺ + α_m w = (1−α_f) a⁺ + α_f a,  a = −ω²q − 2ζω v
Eigen::Matrix3d amplification(double radius, double frequency, double damping, double h) {
  const double alpha_m = (2 * radius - 1) / (radius + 1), alpha_f = radius / (radius + 1);
  const double gamma = 0.5 - alpha_m + alpha_f, beta = 0.25 * std::pow(0.5 + gamma, 2);
  const double k = frequency * frequency, c = 2 * damping * frequency;
  Eigen::Matrix3d implicit, explicit_;
  implicit << 1, 0, -h * h * beta,  //
      0, 1, -h * gamma,             //
      (1 - alpha_f) * k, (1 - alpha_f) * c, 1 - alpha_m;
  explicit_ << 1, h, h * h * (0.5 - beta),  //
      0, 1, h * (1 - gamma),                //
      -alpha_f * k, -alpha_f * c, -alpha_m;
  return implicit.inverse() * explicit_;
}

/// The principal one of the two that are conjugate; the third is real and belongs to no vibration.
std::complex<double> principal_root(double radius, double frequency, double damping, double h) {
  const Eigen::VectorXcd roots = eigenvalues(amplification(radius, frequency, damping, h));
  Eigen::Index principal = 0;
  roots.imag().maxCoeff(&principal);
  return roots(principal);
}

/// A thousand periods. Beyond the first steps only the pair of principal roots λ is left, and
///     D_n = x_{n+1} x_{n−1} − x_n²,   D_{n+1} = |λ|² D_n
/// for every sequence x_n = Re(c λⁿ).
TEST_P(SchemeHardCase, DampsAFreeVibrationAsTheEigenvaluesOfTheSchemeSay) {
  const double frequency = 2 * std::numbers::pi, damping = 1e-5, h = 0.05;
  for (const double radius : {0.0, 0.3, 0.6, 0.8, 0.9, 0.99, 1.0}) {
    const auto analysis =
        run("free_vibration", {fmt::format("/simulation/spectral_radius={:g}", radius)});
    const Eigen::RowVectorXd x = history_of(*analysis, "end").array() - 1.1;  // rest position
    const auto determinant = [&](Eigen::Index n) { return x(n + 1) * x(n - 1) - x(n) * x(n); };
    const double expected = std::log(std::abs(principal_root(radius, frequency, damping, h)));
    // Down to a hundred-thousandth of the amplitude: below, the round-off of 1.1 m comes near.
    const Eigen::Index first = 100;
    const Eigen::Index last =
        std::min(x.size() - 2, first + static_cast<Eigen::Index>(-std::log(1e5) / expected));
    const double found =
        0.5 * std::log(determinant(last) / determinant(first)) / static_cast<double>(last - first);
    EXPECT_NEAR(found / expected, 1.0, 1e-6) << radius;
  }
}

/// A period is too long by the phase of the eigenvalue; without it, the amplitude proves little.
TEST_P(SchemeHardCase, LagsInAFreeVibrationAsTheEigenvaluesOfTheSchemeSay) {
  const double frequency = 2 * std::numbers::pi, h = 0.05;
  const auto analysis = run("free_vibration");
  const Eigen::RowVectorXd x = history_of(*analysis, "end").array() - 1.1;
  const std::complex<double> root = principal_root(0.9, frequency, 1e-5, h);
  // Steps n and n + 1 give c of x_n = Re(c λⁿ), and that the whole rest.
  const Eigen::Index first = 100, last = x.size() - 1;
  Eigen::Matrix2d basis;
  basis << 1, 0, root.real(), -root.imag();
  const Eigen::Vector2d c = basis.inverse() * Eigen::Vector2d(x(first), x(first + 1));
  const std::complex<double> end =
      std::complex<double>(c(0), c(1)) * std::pow(root, static_cast<double>(last - first));
  EXPECT_NEAR(x(last), end.real(), 1e-9);
}

// Newmark's scheme and implicit Euler in hard cases: what they damp, and that they are of first
// order (Newmark's of second without damping).

class DampedScheme : public HardCase {
 protected:
  static std::unique_ptr<Analysis> run_with(const std::string& scheme, const std::string& name,
                                            std::vector<std::string> overrides) {
    overrides.push_back("/simulation/scheme=" + scheme);
    return run(name, overrides);
  }
};
PLEUEL_WITH_EACH_FORMULATION(DampedScheme);

/// Of problems/hard/free_vibration.json.
constexpr double frequency = 2 * std::numbers::pi, damping = 1e-5, step = 0.05;

/// ln |λ| of the principal roots of one step of Newmark's scheme (1959) on
/// q̈ + 2ζω q̇ + ω² q = 0,
///     q⁺ = q + hv + h²(½−β) a + h²β a⁺,  v⁺ = v + h(1−γ) a + hγ a⁺
double newmark_decay(double radius) {
  const double alpha = (1 - radius) / (1 + radius), h = step;
  const double gamma = 0.5 + alpha, beta = 0.25 * (1 + alpha) * (1 + alpha);
  Eigen::Matrix3d implicit, explicit_;
  implicit << 1, 0, -h * h * beta,  //
      0, 1, -h * gamma,             //
      frequency * frequency, 2 * damping * frequency, 1;
  explicit_ << 1, h, h * h * (0.5 - beta),  //
      0, 1, h * (1 - gamma),                //
      0, 0, 0;
  const Eigen::VectorXcd roots = eigenvalues(implicit.inverse() * explicit_);
  Eigen::Index principal = 0;
  roots.imag().maxCoeff(&principal);
  return std::log(std::abs(roots(principal)));
}

/// The same of a history x_n = Re(c λⁿ), from D_n = x_{n+1} x_{n−1} − x_n², D_{n+1} = |λ|² D_n,
/// down to a hundred-thousandth of the amplitude.
double decay_of(const Eigen::RowVectorXd& x, double expected) {
  const auto determinant = [&](Eigen::Index n) { return x(n + 1) * x(n - 1) - x(n) * x(n); };
  const Eigen::Index first = 5;
  const Eigen::Index last =
      std::min(x.size() - 2, first + static_cast<Eigen::Index>(-std::log(1e5) / expected));
  return 0.5 * std::log(determinant(last) / determinant(first)) / static_cast<double>(last - first);
}

TEST_P(DampedScheme, OfNewmarkDampsAFreeVibrationAsItsEigenvaluesSay) {
  for (const double radius : {0.0, 0.5, 0.8, 0.99, 1.0}) {
    const auto analysis = run_with("newmark", "free_vibration",
                                   {fmt::format("/simulation/spectral_radius={:g}", radius)});
    const double expected = newmark_decay(radius);
    const double found = decay_of(history_of(*analysis, "end").array() - 1.1, expected);
    EXPECT_NEAR(found / expected, 1.0, 1e-6) << radius;
  }
}

/// q⁺ = q + h v⁺, v⁺ = v + h a⁺ has |λ|² = 1/(1 + 2ζωh + ω²h²): a tenth of the amplitude is left
/// after two and a half periods.
TEST_P(DampedScheme, OfEulerDampsAFreeVibrationAsItsEigenvaluesSay) {
  const auto analysis = run_with("implicit-euler", "free_vibration", {});
  const double square = frequency * frequency * step * step;
  const double expected = -0.5 * std::log(1 + 2 * damping * frequency * step + square);
  const double found = decay_of(history_of(*analysis, "end").array() - 1.1, expected);
  EXPECT_NEAR(found / expected, 1.0, 1e-6);
}

/// Against the energy of the one coordinate; Newmark's scheme with ρ∞ = 1 has no error of first
/// order, but index 3 is unstable with it.
TEST_P(DampedScheme, BringsTheSliderThroughItsDeadCentresInItsOrder) {
  const RigidSliderCrank reference = steel_slider_crank(1.5);
  const double end = 0.2, exact = reference.slider(reference.coasting_angle(40.0, end));
  struct Case {
    std::string scheme;
    double radius, order;
  };
  std::vector<Case> cases = {{"newmark", 0.8, 1.0}, {"implicit-euler", 0.0, 1.0}};
  if (GetParam() != "index-3") cases.push_back({"newmark", 1.0, 2.0});
  for (const Case& of : cases) {
    std::vector<double> steps, errors;
    for (const double h : {2e-4, 1e-4, 5e-5}) {
      const auto analysis = run_with(
          of.scheme, "dead_centres",
          {step_of(h), end_of(end), fmt::format("/simulation/spectral_radius={:g}", of.radius)});
      steps.push_back(h);
      errors.push_back(std::abs(value_of(*analysis, "slider_end") - exact));
    }
    EXPECT_NEAR(observed_order(steps, errors), of.order, 0.1) << of.scheme;
  }
}

/// Implicit Euler brings a cantilever under a sudden load F to rest at F L³/(3 E I): of its slowest
/// mode, ω = (1.8751/L)² √(EI/ρA), (1 + ω²h²)^(−n/2) is left after n steps.
TEST_P(DampedScheme, OfEulerEndsASuddenLoadInItsStaticDeflection) {
  const double h = 5e-3, end = 1.0, height = 0.02, width = 0.03;
  const double inertia = width * std::pow(height, 3) / 12;
  const double deflection = 20.0 / (3 * 2.1e11 * inertia);
  const double slowest =
      std::pow(1.87510407, 2) * std::sqrt(2.1e11 * inertia / (7850 * width * height));
  const double left = std::pow(1 + slowest * slowest * h * h, -0.5 * end / h);
  const auto analysis = run_with("implicit-euler", "sudden_load", {step_of(h), end_of(end)});
  EXPECT_LE(left, 1e-8);
  EXPECT_NEAR(value_of(*analysis, "tip_end") / -deflection, 1.0, 1e-6);
  // It hardly swings over: generalized-α has twice the static deflection.
  EXPECT_LE(value_of(*analysis, "tip_peak"), 1.5 * deflection);
}

// Steps that follow the local error, and what is promised of them.

/// The slider-crank of dead_centres.json with a rod hardly longer than its crank: the slider waits
/// for half a turn and is thrown to the other side within a few degrees.
std::vector<std::string> flicking(const std::vector<std::string>& more) {
  std::vector<std::string> overrides = {
      "/scene/bodies/rod/to=[0.205, 0, 0]", "/scene/bodies/slider/at=[0.205, 0, 0]",
      "/scene/joints/slider_pin/at=[0.205, 0, 0]", "/scene/joints/guide/at=[0.205, 0, 0]",
      // As fast as the crank turns it, −40 · 0.1/0.105 rad/s.
      "/scene/bodies/rod/angular_velocity=[0, 0, -38.095238095238095]", "/simulation/end_time=0.4"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return overrides;
}

std::string tolerance_of(double tolerance) {
  return fmt::format("/simulation/local_error={:g}", tolerance);
}

class StepControl : public testing::Test {
 protected:
  static ProblemFile problem(std::vector<std::string> overrides,
                             const std::string& formulation = "stabilized-index-2") {
    overrides.push_back("/simulation/formulation=" + formulation);
    return sample_problem("hard/dead_centres", overrides);
  }
  static std::unique_ptr<Analysis> run(const ProblemFile& problem) {
    return analyze(problem, start_design(problem));
  }
  struct Result {
    double end;
    int steps;
  };
  static Result flick(const std::vector<std::string>& more) {
    const auto analysis = run(problem(flicking(more)));
    return {value_of(*analysis, "slider_end"), analysis->trajectory.steps()};
  }
  /// Energy alone says where the crank is at 0.4 s.
  static double exact() {
    static const RigidSliderCrank reference = steel_slider_crank(1.5, 0.105);
    static const double end = reference.slider(reference.coasting_angle(40.0, 0.4));
    return end;
  }
};

/// What the local errors of each regular step may add up to is what all of them add up to, times
/// their number and times what the mechanism makes of it.
TEST_F(StepControl, LeavesAnErrorThatIsProportionalToItsTolerance) {
  std::vector<double> tolerances = {1e-4, 1e-5, 1e-6}, errors;
  for (const double tolerance : tolerances) {
    errors.push_back(std::abs(flick({step_of(4e-3), tolerance_of(tolerance)}).end - exact()));
  }
  EXPECT_NEAR(observed_order(tolerances, errors), 1.0, 0.2);
}

TEST_F(StepControl, NeedsFewerStepsThanEqualOnesForTheSameError) {
  const Result controlled = flick({step_of(4e-3), tolerance_of(1e-6)});
  const Result equal = flick({step_of(0.4 / (2 * controlled.steps))});
  EXPECT_LE(std::abs(controlled.end - exact()), std::abs(equal.end - exact()))
      << controlled.steps << " steps";
}

/// A sequence of halved, quartered and whole steps keeps the order of the scheme: each change
/// begins anew without the old w.
TEST_F(StepControl, ChangesStepsWithoutLossOfOrder) {
  for (const std::string& formulation : formulations()) {
    const auto end_with = [&](int halvings) {
      ProblemFile problem = StepControl::problem({end_of(0.2)}, formulation);
      problem.simulation.step = 8e-3;
      for (int i = 0; i < 25; ++i) {
        const int parts = (1 << halvings) * (i % 3 == 0 ? 1 : i % 3 == 1 ? 4 : 2);
        for (int k = 0; k < parts; ++k) {
          problem.simulation.instants.push_back(8e-3 * (i + static_cast<double>(k) / parts));
        }
      }
      problem.simulation.instants.push_back(0.2);
      return value_of(*run(problem), "slider_end");
    };
    const RigidSliderCrank reference = steel_slider_crank(1.5);
    const double exact = reference.slider(reference.coasting_angle(40.0, 0.2));
    std::vector<double> sizes, errors;
    for (const int halvings : {3, 4, 5, 6}) {
      sizes.push_back(std::ldexp(8e-3, -halvings));
      errors.push_back(std::abs(end_with(halvings) - exact));
    }
    EXPECT_NEAR(observed_order(sizes, errors), 2.0, 0.15) << formulation;
  }
}

/// Of the steps that ran: differences simulate with the very same ones.
TEST_F(StepControl, HasTheGradientOfTheStepsThatRan) {
  ProblemFile problem = StepControl::problem(
      flicking({step_of(4e-3), tolerance_of(1e-4), end_of(0.2),
                R"(/responses/force_peak={"type": "reaction-force",)"
                R"( "joint": "guide", "direction": "y", "over_time": "max-abs"})"}));
  problem.simulation.newton_tolerance = 1e-13;
  const auto [x, analysis] = started(problem);
  ASSERT_GT(analysis->trajectory.rejected_steps, 0);
  const Eigen::MatrixXd direct = direct_gradients(*analysis);
  const ProblemFile repeated = with_steps_of(analysis->trajectory, problem);
  const Eigen::MatrixXd wide = central_differences(repeated, x, 2e-3),
                        narrow = central_differences(repeated, x, 1e-3);
  const Eigen::MatrixXd differences = (4 * narrow - wide) / 3;
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    EXPECT_NEAR(differences(i, 0) / direct(i, 0), 1.0, 1e-6) << problem.responses[i].name;
  }
}

TEST_F(StepControl, RepeatsASequenceOfStepsToRoundOff) {
  const ProblemFile problem = StepControl::problem(flicking({step_of(4e-3), tolerance_of(1e-4)}));
  const auto first = run(problem);
  const auto again = run(with_steps_of(first->trajectory, problem));
  ASSERT_EQ(first->trajectory.time, again->trajectory.time);
  EXPECT_NEAR(value_of(*first, "slider_end"), value_of(*again, "slider_end"), 1e-9);
}

TEST_F(StepControl, SaysWhatErrsTooMuchWithTheSmallestStep) {
  const std::string said = thrown<SimulationError>([&] {
    run(problem(flicking({step_of(4e-3), tolerance_of(1e-9), "/simulation/smallest_step=2 ms"})));
  });
  EXPECT_THAT(said, HasSubstr("simulation stopped at t = "));
  EXPECT_THAT(said, ContainsRegex("with a step of 0.002 s the local error of the "
                                  "body \"(crank|rod|slider)\""));
}

// problems/hard/velocity_jump.json: a drive at rest turns at Ω from one instant to the next.

/// A crank of radius r at rest that turns at Ω from T on, and a uniform rod of length L that is
/// hinged to it and lies along it. The hinge gets the speed u = rΩ across the rod, by an impulse P:
/// m v = P, (m L²/12) ω = −P L/2, v − ω L/2 = u give P = m u/4 and ω = −3u/(2L). From then on, with
/// θ the angle between the two,
///     (m L²/3) θ̈ = −½ m r L Ω² sin θ
struct StruckRod {
  double radius = 0.1, length = 0.3, speed = 20.0, instant = 0.1003;
  double inertia = 0.002;                    ///< of the crank about its bearing
  double mass = 7850.0 * 0.3 * 0.01 * 0.02;  ///< of the rod

  /// θ, θ̇
  Eigen::Vector2d relative(double time) const {
    const double k = 1.5 * radius / length * speed * speed;
    return runge_kutta<Eigen::Vector2d>(
        [k](double, const Eigen::Vector2d& y) {
          return Eigen::Vector2d(y(1), -k * std::sin(y(0)));
        },
        {0.0, -1.5 * radius * speed / length - speed}, time - instant, 2000);
  }
  double tip(double time) const {
    const double phi = speed * (time - instant);
    return radius * std::sin(phi) + length * std::sin(phi + relative(time)(0));
  }
  double tip_speed(double time) const {
    const double phi = speed * (time - instant);
    const Eigen::Vector2d y = relative(time);
    return radius * speed * std::cos(phi) + length * (speed + y(1)) * std::cos(phi + y(0));
  }
  /// Angular momentum about the bearing: all of it comes from the drive.
  double momentum(double time) const {
    const Eigen::Vector2d y = relative(time);
    const double rate = speed + y(1);
    return (inertia + mass * radius * radius) * speed + mass * length * length / 3 * rate +
           0.5 * mass * radius * length * std::cos(y(0)) * (speed + rate);
  }
};

class VelocityJump : public HardCase {};
PLEUEL_WITH_EACH_FORMULATION(VelocityJump);

/// The error of the tip's speed so many steps of 1 ms after the jump [m/s].
double error_of_speed(const Analysis& analysis, int steps_after) {
  const int step = 100 + steps_after;
  return history_of(analysis, "tip_speed")(step) -
         StruckRod().tip_speed(analysis.trajectory.time(step));
}

/// Up to where in its step the jump was, and how that is shared between positions and velocities:
/// the crank pin moves with 2 m/s.
/// @param share  of what it moves in a step
void expect_struck(const Analysis& analysis, double h, double share) {
  const StruckRod rod;
  EXPECT_NEAR(value_of(analysis, "tip_end"), rod.tip(0.3), 2.0 * share * h) << h;
  EXPECT_NEAR(value_of(analysis, "tip_speed"), rod.tip_speed(0.3), 4.0 * share * h) << h;
}

/// Steps that meet the jump in different places.
constexpr std::array<double, 3> steps = {1e-3, 4e-4, 1.6e-4};

TEST_P(VelocityJump, StrikesTheRodAsImpulseAndMomentumSay) {
  const StruckRod rod;
  for (const double h : steps) {
    const auto analysis = run("velocity_jump", {step_of(h)});
    expect_struck(*analysis, h, 0.25);
    EXPECT_NEAR(0.3 * value_of(*analysis, "torque_mean") / rod.momentum(0.3), 1.0, 3.0 * h) << h;
  }
}

/// What generalized-α makes of the rate of a coordinate whose positions are prescribed, over Ω,
/// where they begin to grow by Ω at a share of the first step (Arnold & Brüls 2007):
///     w⁺ = (q⁺ − q − h v)/(h²β) − (½−β)/β w,   v⁺ = v + h (1−γ) w + hγ w⁺
/// It swings about Ω as (c + d n) (−ρ∞)ⁿ: what the scheme does to an infinite frequency.
std::vector<double> rates_after_jump(double radius, double share, int count) {
  const double alpha_m = (2 * radius - 1) / (radius + 1), alpha_f = radius / (radius + 1);
  const double gamma = 0.5 - alpha_m + alpha_f, beta = 0.25 * std::pow(0.5 + gamma, 2);
  std::vector<double> rates;
  double v = 0.0, w = 0.0;  // h = Ω = 1
  for (int n = 0; n < count; ++n) {
    const double w_new = ((n == 0 ? share : 1.0) - v) / beta - (0.5 - beta) / beta * w;
    v += (1 - gamma) * w + gamma * w_new;
    w = w_new;
    rates.push_back(v);
  }
  return rates;
}

/// Index 3 knows velocities by positions only. An error e of the speed of the pin makes one of −e/2
/// at the tip, as the jump does.
TEST(Index3, SwingsInItsVelocitiesAfterAJumpAsItsSchemeSays) {
  const StruckRod rod;
  const auto [problem, x, analysis] =
      AtStart(sample_problem("hard/velocity_jump", {"/simulation/formulation=index-3"}));
  const std::vector<double> rates = rates_after_jump(0.8, 0.7, 40);
  for (int n : {1, 2, 3}) {
    const double swing = rates[n - 1] - 1.0;
    const double expected = -0.5 * swing * rod.radius * rod.speed;
    // The rod turns by half a degree a step.
    EXPECT_NEAR(error_of_speed(*analysis, n) / expected, 1.0, 0.01) << n;
  }
  EXPECT_GE(std::abs(rates[0] - 1.0), 0.3);
  EXPECT_LE(std::abs(error_of_speed(*analysis, 40)), 1e-3);  // 0.8⁴⁰ = 1e-4; measured 2.6e-4
}

/// Stabilized index 2 and a projection impose velocities themselves (measured 5e-4 and 2e-4 m/s).
TEST(VelocityConstraints, FollowAJumpAtOnce) {
  for (const std::vector<std::string>& overrides :
       {std::vector<std::string>{"/simulation/formulation=stabilized-index-2"},
        {"/simulation/formulation=index-1", "/simulation/projection=true"}}) {
    const auto [problem, x, analysis] = AtStart(sample_problem("hard/velocity_jump", overrides));
    for (int i : {1, 2, 3}) EXPECT_LE(std::abs(error_of_speed(*analysis, i)), 2e-3) << i;
  }
}

/// Accelerations of the law are nothing but zero at every step, before and after.
TEST(Index1, DoesNotSeeAVelocityJumpAndStopsWhereTheDriveIsLeftBehind) {
  const ProblemFile problem =
      sample_problem("hard/velocity_jump", {"/simulation/formulation=index-1"});
  EXPECT_THAT(thrown<SimulationError>([&] { analyze(problem, start_design(problem)); }),
              HasSubstr("have drifted, those of the joint \"bearing\""))
      << "the crank stays where it is";
}

/// The change of velocities of least kinetic energy is what an impulse does. That of positions
/// within the step of the jump is not weighed by masses (measured 0.45 of what the pin moves in a
/// step).
TEST(Index1, SeesAVelocityJumpByItsProjection) {
  for (const double h : steps) {
    const auto [problem, x, analysis] =
        AtStart(sample_problem("hard/velocity_jump", {"/simulation/formulation=index-1",
                                                      "/simulation/projection=true", step_of(h)}));
    expect_struck(*analysis, h, 0.5);
  }
}

/// Where a step is projected by millimetres and by 20 rad/s, all of its derivatives count: those of
/// the directions along which it is projected, too, as the rod has fallen a little and its frame is
/// at the far end.
TEST(Index1, HasTheGradientOfAProjectionThatLeadsFar) {
  ProblemFile problem = sample_problem(
      "hard/velocity_jump",
      {"/simulation/formulation=index-1", "/simulation/projection=true", end_of(0.12),
       "/scene/gravity=[0, -9.81, 0]", R"(/scene/bodies/rod/from=[{"variable": "rod_end"}, 0, 0])",
       R"(/scene/bodies/rod/to=[{"variable": "radius"}, 0, 0])", "/responses/tip_end/at=0",
       "/responses/tip_speed/at=0"});
  problem.simulation.newton_tolerance = 1e-13;
  std::erase_if(problem.responses, [](const ResponseSettings& response) {
    const auto* motion = response.as<PointMotionResponse>();
    return motion == nullptr || motion->derivative > TimeDerivative::first;
  });
  const auto [x, analysis] = started(problem);
  const auto values = response_values(*analysis);
  const Eigen::MatrixXd direct = sampled_gradients(*analysis, values, ExactMethod::direct),
                        adjoint = sampled_gradients(*analysis, values, ExactMethod::adjoint);
  EXPECT_LE((adjoint - direct).norm(), 1e-12 * direct.norm());
  const Eigen::MatrixXd wide = central_differences(problem, x, 1e-3),
                        narrow = central_differences(problem, x, 5e-4);
  EXPECT_NEAR((wide - direct).norm() / (narrow - direct).norm(), 4.0, 0.01);
  const Eigen::MatrixXd extrapolated = (4 * narrow - wide) / 3;
  EXPECT_LE((extrapolated - direct).norm(), 5e-10 * direct.norm());  // measured 4e-11
}

}  // namespace
}  // namespace pleuel::test::scheme_test
