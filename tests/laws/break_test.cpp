#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/integration/simulate.hpp"
#include "core/scene/time_breaks.hpp"
#include "core/trust/fast_laws.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "tests/laws/law_problems.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::break_test {
namespace {

SimulationOptions options_with(const std::vector<double>& breaks) {
  SimulationOptions options{1.0, 0.01, 0.8};
  options.breaks = breaks;
  return options;
}

bool holds(const std::vector<double>& instants, double time) {
  return std::find(instants.begin(), instants.end(), time) != instants.end();
}

TEST(Instants, AreEqualWithoutBreaks) {
  const std::vector<double> instants = regular_instants(options_with({}));
  ASSERT_EQ(instants.size(), 101U);
  for (int i = 0; i <= 100; ++i) EXPECT_EQ(instants[i], 1.0 * i / 100);
}

/// A stretch of n + 0.x steps is made in n + 1 equal ones: n ≥ 8 here.
TEST(Instants, LieOnBreaksWithStepsThatDifferLittle) {
  const std::vector<double> breaks = {0.7112, 0.333, -0.5, 0.0, 0.0859, 1.0, 1.7};
  const std::vector<double> instants = regular_instants(options_with(breaks));
  for (const double time : {0.0, 0.0859, 0.333, 0.7112, 1.0}) EXPECT_TRUE(holds(instants, time));
  EXPECT_EQ(instants.back(), 1.0);
  for (std::size_t i = 1; i < instants.size(); ++i) {
    EXPECT_LE(instants[i] - instants[i - 1], 0.01 * (1 + 1e-12));
    EXPECT_GE(instants[i] - instants[i - 1], 0.01 * 8 / 9);
  }
}

TEST(Instants, LeaveOutBreaksThatFollowEachOtherTooClosely) {
  const std::vector<double> instants = regular_instants(options_with({0.5, 0.5011, 0.5031}));
  EXPECT_TRUE(holds(instants, 0.5));
  EXPECT_FALSE(holds(instants, 0.5011));
  EXPECT_TRUE(holds(instants, 0.5031));
}

/// Regular steps that meet a break are left as they are.
TEST(Instants, StayEqualWhereBreaksLieOnThem) {
  const std::vector<double> with = regular_instants(options_with({0.25, 0.5})),
                            without = regular_instants(options_with({}));
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) EXPECT_NEAR(with[i], without[i], 1e-15);
}

TEST(Breaks, AreTheTimesOfTablesButForSamplesOfSomethingSmooth) {
  const auto breaks_of = [](const std::string& interpolation, double step) {
    const ProblemFile problem =
        pushed_block(R"({"type": "table", "times": [0, 0.05, 0.07], "values": [0, 1, 0],
                         "interpolation": ")" +
                     interpolation + "\"}");
    return time_breaks(problem.scene, {1.0, step}).size() / 2;  // two loads
  };
  EXPECT_EQ(breaks_of("linear", 1e-3), 3U);
  EXPECT_EQ(breaks_of("linear", 1e-2), 1U);
  EXPECT_EQ(breaks_of("step", 1e-2), 3U);
  EXPECT_EQ(breaks_of("monotone", 1e-3), 2U);
}

/// A push F from t₁ to t₂, between the steps: v = F (t₂ − t₁)/m, x = v (T − (t₁ + t₂)/2). Without
/// instants there the impulse errs by up to F h/2.
TEST(SteppedLoad, GivesItsImpulseWhereverItFallsBetweenSteps) {
  const double force = 6.0, from = 0.0313, to = 0.0771, mass = 2.0;
  const double v = force * (to - from) / mass, x = v * (0.1 - (from + to) / 2);
  const std::string table = R"({"type": "table", "times": [0, 0.0313, 0.0771], "values": [0, 6, 0],
                                "interpolation": "step"})";
  for (const char* radius : {"0", "0.8"}) {
    std::vector<double> steps, errors;
    for (const double h : {2e-3, 1e-3, 5e-4, 2.5e-4}) {
      const ProblemFile problem =
          pushed_block(table, {"/simulation/step=" + std::to_string(h),
                               std::string("/simulation/spectral_radius=") + radius});
      const auto analysis = analyze(problem, start_design(problem));
      const Eigen::VectorXd values = values_of(*analysis);
      steps.push_back(h);
      errors.push_back(std::abs(values(0) - x) + 0.1 * std::abs(values(1) - v));
      EXPECT_LE(errors.back(), 2 * force / mass * h * h) << radius << " " << h;
    }
    EXPECT_GE(observed_order(steps, errors), 1.7) << radius;
  }
}

/// Across the slide the block does not move: the reaction is the load.
TEST(Peak, OfWhatFollowsALoadIsThatOfTheLoad) {
  for (const char* interpolation : {"step", "linear", "monotone"}) {
    const ProblemFile problem =
        pushed_block(std::string(R"({"type": "table", "times": [0, 0.0213, 0.0457, 0.0834],
                        "values": [0, 5, 20, 1], "interpolation": ")") +
                     interpolation + "\"}");
    EXPECT_NEAR(value_at_start(problem, "reaction"), 20.0, 20.0 * 2e-3) << interpolation;
    if (std::string(interpolation) == "monotone") continue;
    EXPECT_NEAR(value_at_start(problem, "reaction"), 20.0, 1e-9) << interpolation;
  }
}

/// A press that closes within 50 ms, as the default has it: never below zero, never above.
TEST(LoadTable, IsStraightUnlessToldOtherwise) {
  const ProblemFile press = pushed_block(
      R"({"type": "table", "times": [0, 0.025, 0.03, 0.035, 0.06], "values": [0, 0, 20, 0, 0]})");
  // Half the base times the height, over the mass.
  EXPECT_NEAR(value_at_start(press, "v"), 0.5 * 0.01 * 20 / 2, 1e-12);
  EXPECT_NEAR(value_at_start(press, "reaction"), 20.0, 1e-9);
}

constexpr double young = 2.1e11, density = 7850, gravity = 9.81, width = 0.02, height = 0.03;
constexpr double stiffness = young * width * height * height * height / 12;  // E I
constexpr double weight = density * width * height * gravity;                // per length
constexpr double sag = -weight / (8 * stiffness);                            // length 1

const std::string sudden = R"({"type": "table", "times": [-1, 0],
                               "values": [0, {"variable": "force"}], "interpolation": "step"})";

TEST(QuasiStaticStart, IsInEquilibriumWithWhatActsBeforeIt) {
  const auto [problem, x, analysis] =
      AtStart(loaded_cantilever(sudden, {"/simulation/end_time=0.6"}));
  const Eigen::MatrixXd& deflection = analysis->histories[0];
  EXPECT_NEAR(deflection(0, 0), sag, 1e-5 * std::abs(sag));
  // The first vibration has 25 periods a second and loses 40 % in each.
  const double loaded = sag - 50.0 / (3 * stiffness);
  EXPECT_NEAR(values_of(*analysis)(response_index(problem, "end")), loaded,
              0.02 * std::abs(loaded));
  // It swings beyond that, but not as far as without damping.
  const double lowest = values_of(*analysis)(response_index(problem, "sag"));
  EXPECT_LT(lowest, loaded + 0.5 * (loaded - sag));
  EXPECT_GT(lowest, loaded + 1.01 * (loaded - sag));
}

TEST(QuasiStaticStart, StaysWhereItIsUnderALoadThatActsAlready) {
  const auto [problem, x, analysis] = AtStart(loaded_cantilever(
      R"({"type": "table", "times": [0, 1], "values": [{"variable": "force"}, {"variable": "force"}]})"));
  const double loaded = sag - 50.0 / (3 * stiffness);
  for (const char* name : {"sag", "end"}) {
    EXPECT_NEAR(values_of(*analysis)(response_index(problem, name)), loaded,
                1e-5 * std::abs(loaded));
  }
}

TEST(SuddenLoad, HasTheGradientOfItsSimulation) {
  for (const char* formulation : {"index-3", "stabilized-index-2", "index-1"}) {
    const ProblemFile problem =
        loaded_cantilever(sudden, {std::string("/simulation/formulation=") + formulation,
                                   "/simulation/newton_tolerance=1e-13"});
    const auto [direct, adjoint, expected] = law_gradients(problem);
    EXPECT_LE(relative_difference(adjoint, direct), 1e-10) << formulation;
    for (Eigen::Index i = 0; i < expected.rows(); ++i) {
      for (Eigen::Index j = 0; j < expected.cols(); ++j) {
        EXPECT_NEAR(direct(i, j), expected(i, j), 1e-6 * expected.row(i).norm())
            << formulation << " " << i << " " << j;
      }
    }
  }
}

TEST(DriveTable, RefusesToJump) {
  EXPECT_THAT(thrown<InputError>([&] {
                sample_problem("robot_arm", {"/scene/joints/turntable/drive/interpolation=step"});
              }),
              HasSubstr("would move a drive in no time"));
}

/// Between two equal values a drive rests if its table does not say otherwise; a spline would go
/// further, as it does if it is asked for.
TEST(DriveTable, StaysBetweenItsValuesUnlessItIsASpline) {
  const auto farthest = [](const std::string& interpolation) {
    const ProblemFile problem = problem_from(R"({"scene": {
            "bodies": {"block": {"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]}},
            "joints": {"guide": {"type": "prismatic", "bodies": ["ground", "block"],
              "at": [0, 0, 0], "axis": [1, 0, 0], "drive": {"type": "table",
                "times": [0, 1, 2, 3], "values": [0, 0.1, 0.1, 0])" +
                                             interpolation + R"(}}}},
          "simulation": {"end_time": 3, "step": 0.02},
          "responses": {"x": {"type": "position", "body": "block", "direction": "x", "over_time": "max"}}})");
    return analyze(problem, start_design(problem))->reductions[0].value;
  };
  EXPECT_NEAR(farthest(""), 0.1, 1e-9);
  EXPECT_NEAR(farthest(R"(, "interpolation": "monotone")"), 0.1, 1e-9);
  EXPECT_GT(farthest(R"(, "interpolation": "spline")"), 0.105);
}

/// It began with 14 degrees a second.
TEST(DriveTable, OfTheRobotArmStartsAtRest) {
  for (const char* interpolation : {"spline", "monotone"}) {
    const auto [problem, x, analysis] = AtStart(sample_problem(
        "robot_arm", {std::string("/scene/joints/turntable/drive/interpolation=") + interpolation,
                      "/simulation/end_time=10 ms"}));
    State start = state_of(analysis->trajectory, 0);
    EXPECT_LE(start.v.lpNorm<Eigen::Infinity>(), 1e-12) << interpolation;
  }
}

// Jerks: rates of accelerations.

/// A carriage with the motion c t³ and a wheel on it with the angle c t³, c = 2.
ProblemFile cubic_motion(const std::vector<std::string>& changes = {}) {
  return problem_from(R"({"scene": {"bodies": {
    "carriage": {"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]},
    "wheel": {"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]}},
  "joints": {
    "rail": {"type": "prismatic", "bodies": ["ground", "carriage"], "at": [0, 0, 0],
              "axis": [1, 0, 0], "drive": {"type": "polynomial", "coefficients": [0, 0, 0, {"variable": "c"}]}},
    "hub": {"type": "revolute", "bodies": ["carriage", "wheel"], "at": [0, 0, 0],
             "axis": [0, 0, 1], "drive": {"type": "polynomial", "coefficients": [0, 0, 0, {"variable": "turn"}]}}}},
  "variables": {"c": {"start": 2, "lower": 1, "upper": 3}, "turn": {"start": 2, "lower": 1, "upper": 3}},
  "simulation": {"end_time": 0.5, "step": 0.01},
  "responses": {
    "jerk": {"type": "jerk", "body": "carriage", "direction": "x", "over_time": "max-abs"},
    "least": {"type": "jerk", "body": "carriage", "direction": [1, 0, 0], "over_time": "min"},
    "first": {"type": "jerk", "body": "carriage", "direction": "x", "to": 0.02, "over_time": "mean"},
    "turning": {"type": "angular-jerk", "body": "wheel", "direction": "z", "over_time": "final"}},
  "objective": {"minimize": "jerk"}})",
                      changes);
}

/// 6 c at all instants, the first and the last as well.
TEST(Jerk, OfACubicMotionIsConstant) {
  const auto [problem, x, analysis] = AtStart(cubic_motion());
  for (const Reduction& reduction : analysis->reductions) EXPECT_NEAR(reduction.value, 12.0, 1e-7);
  for (const ExactMethod method : {ExactMethod::direct, ExactMethod::adjoint}) {
    const Eigen::MatrixXd gradients =
        sampled_gradients(*analysis, response_values(*analysis), method);
    const Eigen::MatrixXd expected{{6.0, 0.0}, {6.0, 0.0}, {6.0, 0.0}, {0.0, 6.0}};
    EXPECT_LE((gradients - expected).cwiseAbs().maxCoeff(), 1e-6) << gradients;
  }
}

/// 20 (t − t₀)³: 120 m/s³, in all formulations.
TEST(Jerk, BehindACornerOfADriveIsRight) {
  const std::string corner =
      R"(/scene/joints/rail/drive={"type": "expression", "value": "= c * 10 m/s^3 * max(0 s, t - 100 ms)^3"})";
  for (const char* formulation : {"index-3", "stabilized-index-2", "index-1"}) {
    const AtStart run(
        cubic_motion({corner, fmt::format("/simulation/formulation={}", formulation)}));
    EXPECT_NEAR(run.analysis->reductions[0].value, 120.0, 1e-6) << formulation;
  }
}

TEST(Jerk, HasNoMagnitudeOfItsOwn) {
  EXPECT_THAT(
      thrown<InputError>([&] { cubic_motion({"/responses/jerk/direction=\"magnitude\""}); }),
      HasSubstr("the magnitude of the jerk is no rate of that of the "
                "acceleration"));
}

/// The tip of a cantilever under a load that comes up: a peak between the steps, and the mean square.
TEST(Jerk, HasTheGradientOfItsSimulation) {
  const ProblemFile problem = loaded_cantilever(
      R"({"type": "ramp", "to": {"variable": "force"}, "begin": 0.02, "end": 0.06, "rounding": 0.01})",
      {R"(/responses/end={"type": "jerk", "body": "beam", "at": 1, "direction": "y", "over_time": "rms"})",
       R"(/responses/sag={"type": "jerk", "body": "beam", "at": 1, "direction": "y",
          "over_time": "max", "to": 0.05})",
       "/simulation/newton_tolerance=1e-13"});
  const auto [direct, adjoint, expected] = law_gradients(problem);
  EXPECT_LE(relative_difference(adjoint, direct), 1e-9);
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    EXPECT_LE((direct.row(i) - expected.row(i)).norm(), 1e-5 * expected.row(i).norm()) << i;
  }
}

}  // namespace
}  // namespace pleuel::test::break_test
