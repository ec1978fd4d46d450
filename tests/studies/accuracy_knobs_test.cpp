#include "studies/accuracy_knobs.hpp"

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "optimization/design/design_solve.hpp"
#include "studies/accuracy.hpp"
#include "tests/studies/quick_problem.hpp"

namespace pleuel::test::accuracy_knobs_test {
namespace {

std::string word_of(const Override& one) {
  return one.pointer + "=" +
         std::visit([](const auto& value) { return fmt::format("{}", value); }, one.value);
}

/// Values of the responses, or why there are none.
std::string outcome(const ProblemFile& problem) {
  try {
    const Eigen::VectorXd values = values_of(*analyze(problem, start_design(problem)));
    return fmt::format("{}", fmt::join(values.data(), values.data() + values.size(), " "));
  } catch (const SimulationError& error) {
    return error.what();
  }
}

void expect_same_on_the_command_line(const std::vector<std::string>& base,
                                     const std::vector<Variation>& variations) {
  const ProblemFile problem = test::quick_problem(base);
  EXPECT_FALSE(variations.empty());
  const std::string before = outcome(problem);
  for (const Variation& one : variations) {
    std::vector<std::string> words = base;
    for (const Override& change : one.overrides) words.push_back(word_of(change));
    const std::string changed = outcome(one.of(problem));
    EXPECT_EQ(changed, outcome(test::quick_problem(words))) << one.knob << " " << one.value;
    EXPECT_NE(changed, before) << one.knob << " " << one.value;
  }
}

std::vector<Variation> effects_of(const ProblemFile& problem) {
  return effect_variations(problem, analyze(problem, start_design(problem))->model);
}

std::vector<std::string> names_of(const std::vector<Variation>& variations) {
  std::vector<std::string> names;
  for (const Variation& one : variations) names.push_back(one.knob + " " + one.value);
  return names;
}

AccuracyStudy varied_study(const ProblemFile& problem, const PricedDesign& design) {
  AccuracyStudy study = accuracy_study(problem, design);
  vary_settings(problem, design, study);
  return study;
}

TEST(AccuracyKnobs, MakeTheSameProblemAsTheirOverrides) {
  expect_same_on_the_command_line({}, numerical_variations(test::quick_problem()));
}

TEST(AccuracyKnobs, MakeTheSameProblemAsTheirOverridesWithStepControlAndModes) {
  const std::vector<std::string> base = {"/simulation/formulation=stabilized-index-2",
                                         "/simulation/local_error=1e-3",
                                         R"(/scene/bodies/rod/reduction={"modes": 2})",
                                         R"(/scene/bodies/crank/reduction={"frequency": "9 kHz"})"};
  expect_same_on_the_command_line(base, numerical_variations(test::quick_problem(base)));
}

TEST(AccuracyKnobs, EffectsMakeTheSameProblemAsTheirOverrides) {
  for (const std::vector<std::string>& base : std::vector<std::vector<std::string>>{
           {},
           {"/effects/geometric_stiffening=off", "/effects/rotary_inertia=off",
            "/scene/gravity=[0, -9.81, 0]"}}) {
    expect_same_on_the_command_line(base, effects_of(test::quick_problem(base)));
  }
}

TEST(AccuracyKnobs, LeaveOutEachEffectThatIsThere) {
  EXPECT_THAT(names_of(effects_of(test::quick_problem())),
              testing::ElementsAre("axial_elasticity and geometric_stiffening off",
                                   "geometric_stiffening off", "rotary_inertia off"));
}

TEST(AccuracyKnobs, IncludeWhatTheFileLeavesOut) {
  const ProblemFile problem =
      test::quick_problem({"/effects/geometric_stiffening=off", "/effects/axial_elasticity=off",
                           "/scene/gravity=[0, -9.81, 0]"});
  // Stiffening needs the axial elasticity that is forbidden: it is no change of its own.
  EXPECT_THAT(names_of(effects_of(problem)),
              testing::ElementsAre("axial_elasticity on", "rotary_inertia off", "gravity off"));
}

/// Re-optimized without stiffening: the price is first order in the change, which is 0.3 % of the
/// mass at this speed (at 100 rad/s, 2.5 %, it is 12 % too high).
TEST(AccuracyKnobs, PricesOfEffectsAreWhatReoptimizingChanges) {
  ProblemFile problem = test::quick_problem({"/scene/joints/bearing/drive/speed=60"});
  problem.accuracy = test::grid({2e-4}, {4}, 1e-2);
  const auto optimum = [](const ProblemFile& file) {
    DesignProblem design(file);
    return solve_design(design, {.backend = "nlopt-mma"});
  };
  const Result with = optimum(problem);
  ASSERT_LT(with.kkt_residual, 1e-3) << with.message;
  const AccuracyStudy study = varied_study(problem, {problem, with.x});
  int priced = 0;
  for (const VariedRun& one : study.effects) {
    if (one.variation.knob != "geometric_stiffening") continue;
    const Result without = optimum(one.variation.of(problem));
    ASSERT_LT(without.kkt_residual, 1e-3) << without.message;
    const double change = without.evaluation.objective - with.evaluation.objective;
    ASSERT_TRUE(one.run.optimum_change);
    EXPECT_NEAR(*one.run.optimum_change / change, 1.0, 0.03)
        << *one.run.optimum_change << " " << change;
    ++priced;
  }
  EXPECT_EQ(priced, 1);
}

TEST(AccuracyKnobs, HaveNoPricesAtTheStart) {
  ProblemFile problem = test::quick_problem();
  problem.accuracy = test::grid({2e-4}, {2}, 1e-2);
  const AccuracyStudy study = varied_study(problem, {problem, start_design(problem)});
  for (const VariedRun& one : study.effects) EXPECT_FALSE(one.run.optimum_change);
  for (const AccuracyRun& run : study.runs) EXPECT_FALSE(run.optimum_change);
}

/// Three corrections a step where index 3 has one: several times the time, whatever the machine.
TEST(AccuracyKnobs, TimesAreComparedWithTheSettingThatIsChanged) {
  ProblemFile problem = test::quick_problem();
  problem.accuracy = test::grid({2e-4}, {2}, 1e-2);
  const AccuracyStudy study = varied_study(problem, {problem, start_design(problem)});
  ASSERT_EQ(study.base, 0u);
  const auto found = std::find_if(study.knobs.begin(), study.knobs.end(), [](const VariedRun& one) {
    return one.variation.value == "index-1 with projection";
  });
  ASSERT_NE(found, study.knobs.end());
  EXPECT_GT(found->time.change, 0.5);
}

TEST(Accuracy, ComparesTheReferenceWithAnotherFormulation) {
  ProblemFile problem = test::quick_problem();
  problem.accuracy = test::grid({2e-4}, {2}, 1e-2);
  const AccuracyStudy study = accuracy_study(problem, {problem, start_design(problem)});
  EXPECT_EQ(study.check.formulation, "stabilized-index-2");
  EXPECT_EQ(study.check.failure, "");
  ProblemFile other = discretized(problem, study.reference.settings);
  other.simulation.formulation = {ConstraintForm::stabilized_index_2};
  const Eigen::VectorXd values = values_of(*analyze(other, start_design(problem)));
  const Eigen::Index torque = 6;  // torque_rms
  const double difference = std::abs(values(torque) / study.reference.values(torque) - 1.0);
  EXPECT_NEAR(study.check.differences(torque) / difference, 1.0, 1e-6);
  EXPECT_GE((study.reference.errors - study.check.differences).minCoeff(), 0.0);
}

/// Errors that are exactly c h², the finest below what counts as known.
TEST(Accuracy, FitsTheOrderOfTheErrorsThatCount) {
  AccuracyStudy study;
  study.counted = {0};
  study.reference.errors = Eigen::VectorXd::Constant(2, 1e-6);
  for (const int elements : {2, 4}) {
    for (const double step : {4e-4, 2e-4, 1e-4, 1e-5}) {
      AccuracyRun run;
      run.settings = {step, elements};
      const double error = std::max(1e4 * step * step, 1e-6) + (elements == 2 ? 0.1 : 0.0);
      run.errors = Eigen::Vector2d(error, 1.0);
      study.runs.push_back(run);
    }
  }
  ASSERT_TRUE(fitted_order(study, &AccuracyRun::errors));
  EXPECT_NEAR(*fitted_order(study, &AccuracyRun::errors), 2.0, 1e-12);
  study.reference.errors *= 1e6;
  EXPECT_FALSE(fitted_order(study, &AccuracyRun::errors));
}

/// Segments without a fraction share the length in proportion to their elements: other elements
/// must not make another beam of it.
TEST(Accuracy, KeepsTheLengthsOfSegments) {
  ProblemFile problem = test::quick_problem(
      {R"(/scene/bodies/rod={"type": "beam", "from": [0.12, 0, 0], "to": [0.3, 0, 0],
          "material": "steel", "frame": "chord", "segments": [
            {"section": {"type": "circle", "diameter": {"variable": "rod_diameter"}}, "elements": 1},
            {"section": {"type": "circle", "diameter": "8 mm"}, "elements": 3}]})"});
  const Eigen::VectorXd x = start_design(problem);
  const double mass = values_of(*analyze(problem, x))(0);
  for (const Discretization& settings :
       {Discretization{2e-4, 2}, Discretization{2e-4, 0, 0.5}, Discretization{2e-4, 0, 3.0}}) {
    EXPECT_NEAR(values_of(*analyze(discretized(problem, settings), x))(0), mass, 1e-12 * mass);
  }
}

}  // namespace
}  // namespace pleuel::test::accuracy_knobs_test
