#include "core/trust/setting_choice.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/relative_error.hpp"
#include "core/response/monitors.hpp"
#include "core/trust/sudden_jumps.hpp"
#include "core/trust/trusted_run.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::setting_choice_test {
namespace {

// Chosen settings are compared with runs at an eighth of their step and four times their elements.

/// A clamped steel beam, 0.3 m long and 20 mm thick, whose tip is pushed with 30 Hz; its lowest
/// natural frequency is 186 Hz.
constexpr const char* cantilever = R"({
  "scene": {
    "materials": {"m": {"young": 210e9, "poisson": 0.3, "density": 7850}},
    "bodies": {"b": {"type": "beam", "from": [0, 0, 0], "to": [0.3, 0, 0], "material": "m",
      "section": {"type": "rectangle", "width": 0.02, "height": 0.02}, "elements": 4,
      "damping": {"stiffness": 1e-4}}},
    "joints": {"f": {"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}},
    "loads": {"push": {"type": "force", "body": "b", "at": [0.3, 0, 0], "direction": [0, 1, 0],
      "value": {"type": "harmonic", "amplitude": 500, "frequency": 30}}}},
  "simulation": {"end_time": 0.1, "step": 1e-4},
  "responses": {
    "stress": {"type": "stress", "body": "b", "over_time": "max"},
    "tip": {"type": "deflection", "body": "b", "at": 1, "over_time": "max-abs"},
    "jerk": {"type": "acceleration", "body": "b", "at": 1, "direction": "magnitude", "over_time": "max"}
  }
})";

/// All of 500 N at once: the tip swings to twice its deflection at rest.
const std::string sudden =
    R"(/scene/loads/push/value={"type": "harmonic", "amplitude": 500, "frequency": 0.1, "phase": 1.5707963})";
const std::string without_jerk =
    R"(/responses={"stress": {"type": "stress", "body": "b", "over_time": "max"},
       "tip": {"type": "deflection", "body": "b", "at": 1, "over_time": "max-abs"}})";

ProblemFile problem_of(const std::vector<std::string>& overrides) {
  return problem_from(cantilever, overrides);
}

SettingChoice choose(const ProblemFile& problem, double target) {
  return choose_setting(problem, start_design(problem), target, coarse_setting(problem),
                        JudgedBy::this_choice);
}

/// The largest relative error of the asked responses.
double true_error(const SettingChoice& choice) {
  const Eigen::VectorXd x = start_design(choice.problem);
  const Eigen::VectorXd values = values_of(*analyze(choice.problem, x));
  const auto exact = analyze(refined(choice.problem, {0.125, 4.0}), x);
  double error = 0.0;
  for (const std::size_t i : asked_responses(choice.problem)) {
    error = std::max(error, value_error(values(i), exact->reductions[i].value, 0.0));
  }
  return error;
}

TEST(SettingChoice, KeepsTheTargetWithTheLeastWork) {
  const ProblemFile problem = problem_of({without_jerk});
  double work = 0.0;
  for (const double target : {1e-2, 1e-3, 1e-4}) {
    const SettingChoice choice = choose(problem, target);
    EXPECT_TRUE(choice.is_met) << target;
    EXPECT_LE(choice.chosen.error, target);
    EXPECT_LE(true_error(choice), target);
    EXPECT_GT(choice.chosen.work, work);
    work = choice.chosen.work;
  }
}

/// Eight times the step that was chosen does not do.
TEST(SettingChoice, IsNotMuchFinerThanNeeded) {
  const ProblemFile problem = problem_of({without_jerk});
  const SettingChoice choice = choose(problem, 1e-3);
  SettingChoice coarser = choice;
  coarser.problem = refined(choice.problem, {8.0, 1.0});
  EXPECT_GT(true_error(coarser), 1e-3);
}

/// Steps of the period of a vibration that they damp out agree with each other: on half of the
/// truth.
TEST(SettingChoice, IsNotTakenInByStepsThatAgreeByAccident) {
  const ProblemFile problem =
      problem_of({without_jerk, sudden, "/simulation/end_time=1", "/simulation/step=1e-4"});
  const SettingChoice choice = choose(problem, 1e-2);
  EXPECT_TRUE(choice.is_met);
  EXPECT_LE(true_error(choice), 1e-2);
}

/// At the first instant of an undamped blow the acceleration has no limit of fine elements.
TEST(SettingChoice, SaysSoWhereNothingThatWasTriedDoes) {
  const ProblemFile problem = problem_of(
      {sudden, "/simulation/end_time=0.01", "/scene/bodies/b/damping={\"stiffness\": 0}"});
  const SettingChoice choice = choose(problem, 1e-4);
  EXPECT_FALSE(choice.is_met);
  EXPECT_GT(choice.chosen.error, 1e-4);
  for (const TriedSetting& tried : choice.tried) EXPECT_GE(tried.error, choice.chosen.error);
}

/// A fiftieth of the period of the push, and one element: far from where the target is.
TEST(SettingChoice, IsNotBoundByACoarseFile) {
  const ProblemFile problem =
      problem_of({without_jerk, sudden, "/simulation/step=1e-3", "/scene/bodies/b/elements=1"});
  const SettingChoice choice = choose(problem, 1e-4);
  EXPECT_TRUE(choice.is_met);
  EXPECT_GT(1e-3 / choice.chosen.step * choice.chosen.elements, 16.0);
  EXPECT_LE(true_error(choice), 1e-4);
}

/// Steps and elements cannot make up for modes that are missing.
TEST(SettingChoice, KnowsThatModesMissTheTargetByThemselves) {
  const auto with_modes = [](int modes) {
    return choose(
        problem_of({without_jerk, sudden,
                    "/scene/bodies/b/reduction={\"modes\": " + std::to_string(modes) + "}"}),
        1e-3);
  };
  const SettingChoice one = with_modes(1);
  EXPECT_FALSE(one.is_met);
  EXPECT_TRUE(one.is_out_of_reach);
  EXPECT_GT(one.chosen.error, 1e-3);
  const SettingChoice six = with_modes(6);
  EXPECT_TRUE(six.is_met);
  EXPECT_FALSE(six.is_out_of_reach);
}

/// Free of the push the tip is back: its place is judged beside the way that it went.
TEST(SettingChoice, JudgesAValueNearZeroByItsHistory) {
  const ProblemFile problem = problem_of(
      {R"(/scene/loads/push/value={"type": "table", "times": [0, 0.01, 0.02],
           "values": [0, 500, 0], "interpolation": "linear"})",
       R"(/scene/bodies/b/damping={"stiffness": 1e-3})",
       R"(/responses={"place": {"type": "position", "body": "b", "at": 1, "direction": "y",
                                "over_time": "final"}})"});
  const SettingChoice choice = choose(problem, 1e-3);
  EXPECT_TRUE(choice.is_met);
  EXPECT_LE(choice.chosen.step, 1e-2);
}

/// A blow between the instants of the file: runs that do not see it agree that nothing moves.
TEST(SettingChoice, SeesABlowBetweenTheSteps) {
  const ProblemFile problem = problem_of(
      {R"(/scene/loads/push/value={"type": "table", "times": [0, 0.07, 0.0703, 0.0706],
           "values": [0, 0, 500, 0], "interpolation": "linear"})",
       R"(/responses={"tip": {"type": "deflection", "body": "b", "at": 1, "over_time": "max-abs"}})",
       "/simulation/step=2e-4"});
  const SettingChoice choice = choose(problem, 1e-2);
  EXPECT_TRUE(choice.is_met);
  EXPECT_LE(true_error(choice), 1e-2);
}

/// The mean deflection under a load that begins at once needs no steps that follow the vibration, 5.4 ms a
/// period: 64 steps do. But half of the energy is missing then, and what rests on it is not verified.
TEST(SettingChoice, KeepsTheEnergyOfTheMotion) {
  const ProblemFile problem = problem_of(
      {sudden, "/simulation/step=1.5625e-3",
       R"(/responses={"tip": {"type": "deflection", "body": "b", "at": 1, "over_time": "mean"}})"});
  const auto energy_error = [&](const ProblemFile& file) {
    const auto analysis = analyze(file, start_design(problem));
    return monitor(analysis->model, analysis->trajectory).energy_error;
  };
  EXPECT_GT(energy_error(problem), 0.1);
  const SettingChoice choice = choose(problem, 0.02);
  ASSERT_TRUE(choice.is_met);
  EXPECT_LE(choice.tried.front().error, 0.02) << "the steps of the file do by their errors";
  EXPECT_LT(energy_error(choice.problem), 0.03);
}

TEST(AskedResponses, AreAllWhereNothingIsMinimizedLimitedOrListed) {
  EXPECT_THAT(asked_responses(problem_of({})), ElementsAre(0, 1, 2));
  EXPECT_THAT(asked_responses(problem_of({"/accuracy={\"responses\": [\"jerk\"]}"})),
              ElementsAre(2));
  EXPECT_THAT(asked_responses(problem_of({"/constraints={\"soft\": {\"response\": \"tip\", "
                                          "\"upper\": 1}}",
                                          "/accuracy={\"responses\": [\"jerk\"]}"})),
              ElementsAre(1, 2));
}

TEST(AccuracyTarget, ChoosesTheSettingOnlyWhereItIsGiven) {
  EXPECT_FALSE(problem_of({}).accuracy.chooses_setting);
  EXPECT_FALSE(problem_of({"/accuracy={\"error\": 0.1}"}).accuracy.chooses_setting);
  EXPECT_TRUE(problem_of({"/accuracy={\"target\": \"0.1 %\"}"}).accuracy.chooses_setting);
}

Trajectory with_steps_of_one() {
  Trajectory trajectory;
  trajectory.time = Eigen::VectorXd::LinSpaced(11, 0.0, 10.0);
  return trajectory;
}

TEST(ShorterSteps, OfNoneAreThoseOfTheTrajectory) {
  EXPECT_THAT(instants_with(with_steps_of_one(), {}),
              ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
}

/// Short from the jump at 2 to 2.5, with one before it; then no step is 1.3 times as long as the
/// last.
TEST(ShorterSteps, AreShortBehindTheJumpAndGrowSlowly) {
  const Trajectory trajectory = with_steps_of_one();
  const std::vector<double> found = instants_with(trajectory, {{2.0, 2.5, 0.1}});
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
  for (const double time : trajectory.time) EXPECT_TRUE(std::ranges::count(found, time)) << time;
  const auto jump = std::ranges::find(found, 2.0);
  EXPECT_NEAR(*(jump - 1), 1.9, 1e-12);
  EXPECT_EQ(*(jump - 2), 1.0);
  for (auto at = jump; at + 1 != found.end(); ++at) {
    const double step = *(at + 1) - *at;
    EXPECT_LE(step, *at < 2.5 ? 0.1 + 1e-12 : 1.0) << *at;
    EXPECT_LE(step, 1.3 * (*at - *(at - 1))) << *at;
  }
  EXPECT_EQ(found.back(), 10.0);
  EXPECT_LT(found.size(), 50u);
}

/// The first instant has no step before it.
TEST(ShorterSteps, BeginWithTheTrajectory) {
  const std::vector<double> found = instants_with(with_steps_of_one(), {{0.0, 0.5, 0.25}});
  EXPECT_EQ(found[0], 0.0);
  EXPECT_EQ(found[1], 0.25);
}

}  // namespace
}  // namespace pleuel::test::setting_choice_test
