#include <ostream>

#include <Eigen/LU>

#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "core/model/model.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/sample_beams.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/scheme_case.hpp"
#include "tests/support/test.hpp"

/// The size of the local error, of steps of one size and after a change of it, against the jerk of
/// a motion that is known: q = j t³/6.

namespace pleuel::test::order_test {
namespace {

/// A flexible slider-crank in bending that is soft enough for steps in the asymptotic range, driven
/// smoothly from rest: no initial transient, nothing but the order of the scheme.
class SchemeOrder : public testing::Test {
 protected:
  static constexpr double end_time = 0.06;

  struct End {
    Eigen::VectorXd q, v, lambda;
  };

  static End simulate_with(SimulationOptions options, double step) {
    const SampleScene sample = smooth_planar_sample();
    Model model = sample.build();
    options.end_time = end_time;
    options.step = step;
    options.newton_tolerance = 1e-14;
    const Trajectory trajectory = simulate(model.mechanism, options);
    const int last = trajectory.steps();
    return {trajectory.columns().q().col(last), trajectory.columns().v().col(last),
            trajectory.columns().lambda().col(last)};
  }

  struct Orders {
    double q, v, lambda;
  };
  /// Against half the step: round-off of λ, which grows as h⁻², spoils a much finer reference.
  static Orders observe(const SimulationOptions& options) {
    std::vector<double> steps, q, v, lambda;
    for (int n : {1500, 2121, 3000}) {
      const End end = simulate_with(options, end_time / n);
      const End fine = simulate_with(options, end_time / (2 * n));
      steps.push_back(end_time / n);
      q.push_back((end.q - fine.q).norm());
      v.push_back((end.v - fine.v).norm());
      lambda.push_back((end.lambda - fine.lambda).norm());
    }
    return {observed_order(steps, q), observed_order(steps, v), observed_order(steps, lambda)};
  }
};

class EverySchemeOrder : public SchemeOrder, public testing::WithParamInterface<SchemeCase> {};

TEST_P(EverySchemeOrder, IsThatOfItsTheory) {
  SimulationOptions options;
  GetParam().set(options);
  const Orders orders = observe(options);
  EXPECT_NEAR(orders.q, GetParam().order, 0.1);
  EXPECT_NEAR(orders.v, GetParam().order, 0.1);
  // Arnold & Brüls 2007 prove second order for λ, too, after a smooth start. Weakly damped parts of
  // it fall faster (2.16 at ρ∞ = 0.9).
  EXPECT_GE(orders.lambda, GetParam().order - 0.1);
}

/// ρ∞ = 1 keeps for ever what round-off and the start leave in λ, and little by little in v.
TEST_F(SchemeOrder, IsLostByTheMultipliersWithoutNumericalDamping) {
  const Orders orders = observe({{.spectral_radius = 1.0}});
  EXPECT_NEAR(orders.q, 2.0, 0.1);
  EXPECT_LT(orders.lambda, 0.5);  // measured: 0.00
}

INSTANTIATE_TEST_SUITE_P(
    Schemes, EverySchemeOrder,
    testing::Values(SchemeCase{"Radius0", alpha, 0.0, index_3, 2.0},
                    SchemeCase{"Radius05", alpha, 0.5, index_3, 2.0},
                    SchemeCase{"Radius08", alpha, 0.8, index_3, 2.0},
                    SchemeCase{"Radius09", alpha, 0.9, index_3, 2.0},
                    SchemeCase{"StabilizedIndex2", alpha, 0.8, stabilized, 2.0},
                    SchemeCase{"Index1", alpha, 0.8, index_1, 2.0},
                    SchemeCase{"Index1Radius1", alpha, 1.0, index_1, 2.0},
                    SchemeCase{"Baumgarte", alpha, 0.8, baumgarte, 2.0},
                    SchemeCase{"Projected", alpha, 0.8, projected, 2.0},
                    SchemeCase{"NewmarkIndex1", SchemeType::newmark, 1.0, index_1, 2.0},
                    SchemeCase{"DampedNewmark", SchemeType::newmark, 0.5, index_3, 1.0},
                    SchemeCase{"ImplicitEuler", SchemeType::implicit_euler, 0.0, index_3, 1.0},
                    SchemeCase{"ImplicitEulerStabilized", SchemeType::implicit_euler, 0.0,
                               stabilized, 1.0}),
    [](const auto& test) { return test.param.name; });

/// Largest |Φ| and |dΦ/dt| of a trajectory.
struct Drift {
  double position = 0.0, velocity = 0.0;
};

Drift drift_of(System& system, const Trajectory& trajectory) {
  Drift drift;
  State state;
  Eigen::VectorXd residual;
  const auto largest = [&](ConstraintLevel level) {
    system.residual(state, level, residual);
    return residual.tail(system.multipliers()).lpNorm<Eigen::Infinity>();
  };
  for (int step = 1; step <= trajectory.steps(); ++step) {
    trajectory.states->load(step, state);
    drift.position = std::max(drift.position, largest(ConstraintLevel::position));
    drift.velocity = std::max(drift.velocity, largest(ConstraintLevel::velocity));
  }
  return drift;
}

class Formulations : public testing::TestWithParam<int> {
 protected:
  Drift drift_with(const Formulation& formulation, double end_time = 0.1) {
    const SampleScene sample = all_samples()[GetParam()];
    Model model = sample.build();
    SimulationOptions options{end_time, 2e-4, 0.8};
    options.formulation = formulation;
    return drift_of(*model.mechanism.system, simulate(model.mechanism, options));
  }
};

/// Constraints that are equations of a step hold to what Newton's method leaves: 1e-10 of the
/// scale.
TEST_P(Formulations, KeepTheConstraintsThatTheyImpose) {
  const Drift index_3 = drift_with({});
  EXPECT_LE(index_3.position, 1e-10);
  const Drift stabilized = drift_with({ConstraintForm::stabilized_index_2});
  EXPECT_LE(stabilized.position, 1e-10);
  EXPECT_LE(stabilized.velocity, 1e-7);
}

/// A projection leaves round-off of both. Measured 4e-14 and 3e-12 at worst.
TEST_P(Formulations, OfIndexOneKeepAllConstraintsByProjection) {
  const Drift projected = drift_with({ConstraintForm::index_1, 0.0, true});
  EXPECT_LE(projected.position, 1e-12);
  EXPECT_LE(projected.velocity, 1e-10);
}

/// Without stabilization positions drift; Baumgarte's terms hold them back.
TEST_P(Formulations, OfIndexOneDriftUnlessStabilized) {
  const Drift free = drift_with({ConstraintForm::index_1});
  const Drift held = drift_with({ConstraintForm::index_1, 200.0});
  EXPECT_GE(free.position, 1e-9);
  EXPECT_LE(held.position, 0.5 * free.position);
}

INSTANTIATE_TEST_SUITE_P(Samples, Formulations, testing::Range(0, sample_count),
                         [](const auto& test) { return all_samples()[test.param].name; });

constexpr double jerk = 24.0, mass = 1.7;

/// A free mass that a force m j t pushes along x.
Model pushed_mass() {
  Scene scene;
  scene.bodies = {{"mass", PointMass{{0.3, 0.0, 0.0}, mass}}};
  scene.loads = {{"push", PointLoad{LoadKind::force,
                                    "mass",
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

/// IFToMM benchmark A01: 1 kg at 1 m, from (−1, 0) at rest.
Eigen::Vector2d pendulum_at(double time, double step, EffectChoice spatial) {
  Scene scene;
  scene.gravity = {0.0, -9.81, 0.0};
  // In space a body needs some inertia about the rod; it does not turn that way.
  const double inertia = spatial == EffectChoice::on ? 0.1 : 0.0;
  scene.bodies = {{"mass", RigidBody{{-1.0, 0.0, 0.0}, 1.0, {inertia, 0.0, 0.0, 0.0, 0.0, 0.0}}}};
  Joint joint;
  joint.name = "pin";
  joint.bodies = {ground_name, "mass"};
  joint.at = {0.0, 0.0, 0.0};
  scene.joints = {joint};
  Model model = build_model(scene, {.spatial_motion = spatial}, {}, {});
  SimulationOptions options{time, step, 0.8};
  options.newton_tolerance = 1e-12;
  const Trajectory trajectory = simulate(model.mechanism, options);
  return trajectory.columns().q().col(trajectory.steps()).head<2>();
}

/// IFToMM benchmark A01, exact. Richardson's step removes the h² of the error; measured 3e-10.
TEST(Pendulum, IsWhereTheEllipticFunctionsPutIt) {
  for (auto spatial : {EffectChoice::off, EffectChoice::on}) {
    const double h = 1e-3;
    const Eigen::Vector2d coarse = pendulum_at(1.0, h, spatial),
                          fine = pendulum_at(1.0, h / 2, spatial);
    const Eigen::Vector2d found = fine + (fine - coarse) / 3;
    EXPECT_NEAR(found.x(), 0.98629175113188, 3e-9);
    EXPECT_NEAR(found.y(), -0.16501085312554, 3e-9);
    EXPECT_NEAR(fine.x(), 0.98629175113188, 1e-5);
  }
}

/// A rubber beam that falls from the horizontal and swings, without damping.
double energy_drift(double step) {
  Scene scene = swinging_beam(0.5, RectangleSection{0.02, 0.02}, 3);
  scene.materials[0] = {"steel", 5e6, 0.3, 1100.0};
  Model model = build_model(scene, {}, {}, {});
  SimulationOptions options{0.5, step, 1.0};
  options.spectral_radius = 0.95;
  options.newton_tolerance = 1e-11;
  const Trajectory trajectory = simulate(model.mechanism, options);
  State state = state_of(trajectory, 0);
  const double start = energy_of(model, state);
  double drift = 0.0;
  for (int i = 0; i <= trajectory.steps(); ++i) {
    trajectory.states->load(i, state);
    drift = std::max(drift, std::abs(energy_of(model, state) - start));
  }
  return drift / (0.5 * 9.81 * model.bodies[0].mass * 0.5);  // against what falling sets free
}

TEST(FlexiblePendulum, KeepsItsEnergyTheBetterTheSmallerTheStep) {
  std::vector<double> steps, drifts;
  for (double step : {4e-4, 2e-4, 1e-4}) {
    steps.push_back(step);
    drifts.push_back(energy_drift(step));
  }
  EXPECT_NEAR(observed_order(steps, drifts), 2.0, 0.25);
  EXPECT_LE(drifts.back(), 1e-4);
}

/// Error of λ falls with ℓ⁴ for cubic elements (Strang & Fix 1973); exact roots.
TEST(BeamFrequencyOrder, BendingErrorFallsWithTheFourthPowerOfTheElementLength) {
  std::vector<double> sizes, first, second;
  for (int elements : {4, 8, 16}) {
    const auto beam = uniform_beam(elements, 1.0, rectangle_section(0.02, 0.03), 2.1e11, 7850.0);
    const auto omega = frequencies(beam_invariants(
        beam, tangent_coordinates(elements + 1, bending_y), RotaryInertia::neglected));
    const double unit = std::sqrt(2.1e11 * 0.03 * 0.03 / 12 / 7850);
    sizes.push_back(1.0 / elements);
    first.push_back(std::abs(omega(0) / unit - 3.516015268500151));
    second.push_back(std::abs(omega(1) / unit - 22.034491564666766));
  }
  EXPECT_NEAR(observed_order(sizes, first), 4.0, 0.1);
  EXPECT_NEAR(observed_order(sizes, second), 4.0, 0.1);
}

TEST(BeamFrequencyOrder, AxialErrorFallsWithTheSquareOfTheElementLength) {
  std::vector<double> sizes, errors;
  for (int elements : {4, 8, 16}) {
    const auto beam = uniform_beam(elements, 1.0, rectangle_section(0.02, 0.03), 2.1e11, 7850.0);
    const auto omega =
        frequencies(beam_invariants(beam, tangent_coordinates(elements + 1, axial_only)));
    sizes.push_back(1.0 / elements);
    errors.push_back(std::abs(omega(0) - std::numbers::pi / 2 * std::sqrt(2.1e11 / 7850)));
  }
  EXPECT_NEAR(observed_order(sizes, errors), 2.0, 0.05);
}

}  // namespace
}  // namespace pleuel::test::order_test
