#include "studies/accuracy.hpp"

#include <variant>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/relative_error.hpp"
#include "core/response/analysis.hpp"
#include "optimization/design/design_solve.hpp"
#include "studies/accuracy_knobs.hpp"
#include "studies/accuracy_optimum.hpp"
#include "studies/missing_settings.hpp"
#include "tests/studies/quick_problem.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::accuracy_test {
namespace {

PricedDesign at_start(const ProblemFile& problem) {
  return {problem, start_design(problem)};
}

AccuracyStudy study(double target) {
  const ProblemFile problem = graded_problem({4e-4, 2e-4, 1e-4}, {4}, target);
  return accuracy_study(problem, at_start(problem));
}

constexpr Eigen::Index torque = 6;  // torque_rms: smooth in the step, unlike a maximum

/// Of the responses that are minimized or limited.
double counted_error(const AccuracyStudy& study, const AccuracyRun& run) {
  double largest = 0.0;
  for (const std::size_t i : study.counted) largest = std::max(largest, run.errors(i));
  return largest;
}

TEST(Accuracy, ErrorsFallWithTheStepAsASecondOrderSchemeMust) {
  const AccuracyStudy result = study(1e-3);
  ASSERT_EQ(result.runs.size(), 3u);
  const AccuracyRun &coarse = result.runs[0], &fine = result.runs[2];
  // Halved twice: a factor 16 at least if the reference (half the finest) were exact, 21 as it is,
  // until round-off and the elements take over; first order would give 4.
  EXPECT_GT(coarse.errors(torque) / fine.errors(torque), 8.0);
  EXPECT_LT(fine.gradient_errors.maxCoeff(), coarse.gradient_errors.maxCoeff());
  const AccuracyRun& reference = result.reference;  // is finer than every run
  EXPECT_DOUBLE_EQ(reference.settings.step, 0.5e-4);
  EXPECT_EQ(reference.settings.elements, 8);
  EXPECT_GT(reference.errors.maxCoeff(), 0.0);
  for (const AccuracyRun& run : result.runs) {
    EXPECT_LT(run.errors(0), 1e-12) << "the mass depends on no step";
    EXPECT_GE((run.errors - reference.errors).minCoeff(), 0.0);
    EXPECT_GE((run.gradient_errors - reference.gradient_errors).minCoeff(), 0.0);
  }
}

TEST(Accuracy, RecommendsTheFastestOfThoseThatAreGoodEnough) {
  const AccuracyStudy result = study(0.5);
  ASSERT_EQ(result.recommendations.size(), 3u);
  double target = 0.5;
  for (const Recommendation& one : result.recommendations) {
    EXPECT_NEAR(one.target, target, 1e-12);
    target *= 0.1;
    for (const AccuracyRun& run : result.runs) {
      if (counted_error(result, run) > one.target) continue;
      ASSERT_TRUE(one.values);
      EXPECT_LE(result.runs[*one.values].simulation_seconds, run.simulation_seconds);
    }
    if (!one.values) continue;
    EXPECT_LE(counted_error(result, result.runs[*one.values]), one.target);
  }
  EXPECT_TRUE(result.recommendations.front().values);
}

TEST(Accuracy, RecommendsNothingIfNothingIsGoodEnough) {
  for (const Recommendation& one : study(1e-12).recommendations) {
    EXPECT_FALSE(one.values);
    EXPECT_FALSE(one.gradients);
  }
}

/// Responses that nobody limits have no veto: the end position of the slider, say.
TEST(Accuracy, CountsWhatIsMinimizedOrLimited) {
  const ProblemFile problem = quick_problem();
  const AccuracyStudy result = study(1e-2);
  ASSERT_EQ(result.counted.size(), problem.constraints.size() + 1);
  for (const std::size_t i : result.counted) {
    const std::string& name = problem.responses[i].name;
    EXPECT_TRUE(name == problem.objective->response ||
                std::any_of(problem.constraints.begin(), problem.constraints.end(),
                            [&](const auto& limit) { return limit.response == name; }))
        << name;
  }
}

TEST(Accuracy, TriesStepsAndElementsAroundThoseOfTheFileIfItNamesNone) {
  ProblemFile problem = quick_problem();
  problem.accuracy = {};
  const std::vector<Discretization> grid = accuracy_grid(problem);
  EXPECT_EQ(grid.size(), 12u);
  const AccuracyStudy result = accuracy_study(problem, at_start(problem));
  EXPECT_EQ(result.runs.size(), 12u);
  EXPECT_DOUBLE_EQ(result.reference.settings.step, problem.simulation.step / 4);
  EXPECT_DOUBLE_EQ(result.reference.settings.factor, 4.0);
}

TEST(Accuracy, IsThatOfTheDesignThatIsAskedFor) {
  ProblemFile problem = graded_problem({2e-4}, {2});
  const Eigen::VectorXd x = 0.7 * start_design(problem);
  const AccuracyStudy result = accuracy_study(problem, {problem, x});
  const ProblemFile same = discretized(problem, result.runs[0].settings);
  EXPECT_EQ(result.runs[0].values, values_of(*analyze(same, x)));
}

/// Against a run with a quarter of its step and twice its elements, which is nearly exact beside
/// it.
TEST(Accuracy, EstimatesTheErrorOfItsReference) {
  const AccuracyStudy result = study(1e-3);
  ProblemFile finer = quick_problem();
  finer.simulation.step = result.reference.settings.step / 4;
  for (Body& body : finer.scene.bodies) {
    auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam) beam->segments.front().elements = 2 * result.reference.settings.elements;
  }
  const Eigen::VectorXd exact = values_of(*analyze(finer, start_design(finer)));
  const double error = std::abs(result.reference.values(torque) / exact(torque) - 1.0);
  EXPECT_GT(result.reference.errors(torque), 0.5 * error);
  EXPECT_LT(result.reference.errors(torque), 2.0 * error);
}

TEST(Accuracy, AFailingRunIsMarkedAndTheOthersGoOn) {
  ProblemFile problem =
      graded_problem({5e-3, 1e-4}, {2}, 1e-3, {"/simulation/max_newton_iterations=2"});
  problem.simulation.newton_tolerance = 1e-9;
  const AccuracyStudy result = accuracy_study(problem, at_start(problem));
  EXPECT_FALSE(result.runs[0].failure.empty());
  EXPECT_TRUE(result.runs[1].failure.empty()) << result.runs[1].failure;
}

TEST(Accuracy, WithoutResponsesThereIsNothingToCompare) {
  ProblemFile problem = quick_problem();
  problem.responses.clear();
  EXPECT_THROW(accuracy_study(problem, at_start(problem)), InputError);
}

AccuracyRun run_of(double step, double seconds, double error) {
  AccuracyRun run;
  run.settings = {step, 4};
  run.simulation_seconds = seconds;
  run.errors = Eigen::VectorXd::Constant(1, error);
  return run;
}

TEST(AccuracyOptimum, TriesWhatIsRecommendedAndThanWhichNothingIsBetterInBoth) {
  AccuracyStudy study;
  study.counted = {0};
  study.runs = {run_of(1, 1.0, 0.5), run_of(2, 2.0, 0.6), run_of(3, 3.0, 0.1), run_of(4, 5.0, 0.1),
                run_of(5, 4.0, 0.01)};
  study.runs.push_back(run_of(6, 0.1, 0.0));
  study.runs.back().failure = "it stopped";
  study.recommendations = {{0.6, 1, {}}};
  std::vector<double> steps;
  for (const Discretization& one : efficient_settings(study)) steps.push_back(one.step);
  EXPECT_THAT(steps, ElementsAre(1.0, 2.0, 3.0, 5.0));
}

/// The error of the reference is an estimate: checked against an optimum with half its step and
/// twice its elements.
TEST(AccuracyOptimum, KnowsHowFarItsReferenceIsOff) {
  ProblemFile problem = graded_problem({4e-4}, {2});
  const SolveOptions options{.backend = "nlopt-mma"};
  const Eigen::VectorXd x = plain_optimum(problem, options).x;
  const AccuracyStudy study = accuracy_study(problem, {problem, x});
  const OptimumStudy optima = optimum_study(problem, x, study, options);
  ASSERT_FALSE(optima.reference.has_failed()) << optima.reference.failure;
  ASSERT_TRUE(optima.reference_error);
  const Discretization finer = finer_than(problem, {study.reference.settings});
  const Result better = plain_optimum(discretized(problem, finer), options);
  const double error = std::abs(better.evaluation.objective - optima.reference.objective);
  EXPECT_LE(error, 2.0 * *optima.reference_error);
  EXPECT_GE(error, 0.1 * *optima.reference_error);
  ASSERT_EQ(optima.runs.size(), 1u);
  const OptimumRun& run = optima.runs.front();
  EXPECT_EQ(run.change, run.objective - optima.reference.objective);
  EXPECT_GE(optima.relative_error(run), optima.relative_floor());
  EXPECT_GT(run.seconds, 0.0);
}

/// What stands behind "for instance" and the key, which is how the settings would be written.
std::string example_in(const std::string& message, const std::string& key) {
  const std::string start = "for instance \"" + key + "\": ";
  const std::size_t at = message.find(start);
  return at == std::string::npos ? "" : message.substr(at + start.size());
}

template <class Requirement>
std::string complaint(Requirement require, const ProblemFile& problem) {
  return thrown<InputError>([&] { require(problem); });
}

TEST(MissingSettings, ExampleOfAFrontIsOneOfThisProblem) {
  ProblemFile problem = quick_problem();
  problem.pareto.reset();
  const std::string example = example_in(complaint(require_pareto, problem), "pareto");
  const ProblemFile written = quick_problem({"/pareto=" + example});
  ASSERT_TRUE(written.pareto.has_value()) << example;
  ConstraintSettings& limit = problem.constraints.front();
  EXPECT_EQ(written.pareto->constraint, limit.name);
  EXPECT_NEAR(written.pareto->from, *limit.upper / 2, 0.005 * *limit.upper);
  EXPECT_NEAR(written.pareto->to, *limit.upper * 2, 0.02 * *limit.upper);
  // It takes no limit of two sides.
  ASSERT_GT(problem.constraints.size(), 1u);
  limit.lower = 0.5 * *limit.upper;
  EXPECT_THAT(example_in(complaint(require_pareto, problem), "pareto"),
              AllOf(HasSubstr(problem.constraints[1].name), Not(HasSubstr(limit.name))));
}

TEST(MissingSettings, ExampleOfAFrontVariesALimitInAllLoadCases) {
  ProblemFile problem = read_problem(source_folder() + "/problems/two_loads.json").complete();
  problem.pareto.reset();
  EXPECT_THAT(complaint(require_pareto, problem),
              HasSubstr("\"constraint\": \"crank_strength\", "));
}

TEST(MissingSettings, ExampleOfUncertainParametersIsOneOfThisProblem) {
  ProblemFile problem = quick_problem();
  problem.uncertainty.reset();
  const std::string example = example_in(complaint(require_uncertainty, problem), "uncertainty");
  const ProblemFile written = quick_problem({"/uncertainty=" + example});
  ASSERT_TRUE(written.uncertainty.has_value()) << example;
  ASSERT_EQ(written.uncertainty->parameters.size(), 1u);
}

TEST(MissingSettings, WithoutLimitsAndVariablesThereIsNoExample) {
  ProblemFile problem = quick_problem();
  problem.constraints.clear();
  problem.variables.clear();
  problem.pareto.reset();
  problem.uncertainty.reset();
  EXPECT_THAT(complaint(require_pareto, problem), EndsWith("which limit to vary"));
  EXPECT_THAT(complaint(require_uncertainty, problem), EndsWith("are uncertain"));
  problem.pareto.emplace();
  problem.uncertainty.emplace();
  EXPECT_EQ(complaint(require_pareto, problem), "");
  EXPECT_EQ(complaint(require_uncertainty, problem), "");
}

TEST(RelativeError, IsRelativeToTheReferenceAndNearZeroToAThousandthOfTheMotion) {
  EXPECT_DOUBLE_EQ(value_error(1.01, 1.0, 1.0), 0.01 + (1.01 - 1.0 - 0.01));
  EXPECT_DOUBLE_EQ(value_error(1e-6, 0.0, 1.0), 1e-3);
  EXPECT_EQ(value_error(0.0, 0.0, 0.0), 0.0);
  EXPECT_EQ(gradient_error(Eigen::Vector2d(0, 0), Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1), 0),
            0.0);
}

TEST(RelativeError, OfAGradientDoesNotDependOnTheUnitsOfTheVariables) {
  const Eigen::Vector2d x(0.02, 3.0), reference(5.0, -0.1), gradient(5.1, -0.09);
  const double error = gradient_error(gradient, reference, x, 1.0);
  const Eigen::Vector2d units(1000.0, 1e-6);  // variables in mm and MPa: x grows, gradients shrink
  EXPECT_NEAR(gradient_error(gradient.cwiseQuotient(units), reference.cwiseQuotient(units),
                             x.cwiseProduct(units), 1.0),
              error, 1e-14);
}

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
  const ProblemFile problem = quick_problem(base);
  EXPECT_FALSE(variations.empty());
  const std::string before = outcome(problem);
  for (const Variation& one : variations) {
    std::vector<std::string> words = base;
    for (const Override& change : one.overrides) words.push_back(word_of(change));
    const std::string changed = outcome(one.of(problem));
    EXPECT_EQ(changed, outcome(quick_problem(words))) << one.knob << " " << one.value;
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
  for (const std::vector<std::string>& base : std::vector<std::vector<std::string>>{
           {},
           {"/simulation/formulation=stabilized-index-2", "/simulation/local_error=1e-3",
            R"(/scene/bodies/rod/reduction={"modes": 2})",
            R"(/scene/bodies/crank/reduction={"frequency": "9 kHz"})"}}) {
    expect_same_on_the_command_line(base, numerical_variations(quick_problem(base)));
  }
}

TEST(AccuracyKnobs, EffectsMakeTheSameProblemAsTheirOverrides) {
  for (const std::vector<std::string>& base : std::vector<std::vector<std::string>>{
           {},
           {"/effects/geometric_stiffening=off", "/effects/rotary_inertia=off",
            "/scene/gravity=[0, -9.81, 0]"}}) {
    expect_same_on_the_command_line(base, effects_of(quick_problem(base)));
  }
}

TEST(AccuracyKnobs, LeaveOutEachEffectThatIsThereAndIncludeWhatTheFileLeavesOut) {
  EXPECT_THAT(names_of(effects_of(quick_problem())),
              ElementsAre("axial_elasticity and geometric_stiffening off",
                          "geometric_stiffening off", "rotary_inertia off"));
  // Stiffening needs the axial elasticity that is forbidden: it is no change of its own.
  EXPECT_THAT(names_of(effects_of(quick_problem({"/effects/geometric_stiffening=off",
                                                 "/effects/axial_elasticity=off",
                                                 "/scene/gravity=[0, -9.81, 0]"}))),
              ElementsAre("axial_elasticity on", "rotary_inertia off", "gravity off"));
}

/// Re-optimized without stiffening: the price is first order in the change, which is 0.3 % of the
/// mass at this speed (at 100 rad/s, 2.5 %, it is 12 % too high).
TEST(AccuracyKnobs, PricesOfEffectsAreWhatReoptimizingChanges) {
  const ProblemFile problem =
      graded_problem({2e-4}, {4}, 1e-2, {"/scene/joints/bearing/drive/speed=60"});
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

/// Three corrections a step where index 3 has one: several times the time, whatever the machine.
TEST(AccuracyKnobs, AtTheStartHaveTimesAgainstTheSettingThatIsChangedAndNoPrices) {
  const ProblemFile problem = graded_problem({2e-4}, {2});
  const AccuracyStudy study = varied_study(problem, at_start(problem));
  for (const VariedRun& one : study.effects) EXPECT_FALSE(one.run.optimum_change);
  for (const AccuracyRun& run : study.runs) EXPECT_FALSE(run.optimum_change);
  ASSERT_EQ(study.base, 0u);
  const auto found = std::ranges::find(study.knobs, "index-1 with projection",
                                       [](const VariedRun& one) { return one.variation.value; });
  ASSERT_NE(found, study.knobs.end());
  EXPECT_GT(found->time.change, 0.5);
}

TEST(Accuracy, ComparesTheReferenceWithAnotherFormulation) {
  ProblemFile problem = graded_problem({2e-4}, {2});
  const AccuracyStudy study = accuracy_study(problem, {problem, start_design(problem)});
  EXPECT_EQ(study.check.formulation, "stabilized-index-2");
  EXPECT_EQ(study.check.failure, "");
  ProblemFile other = discretized(problem, study.reference.settings);
  other.simulation.formulation = {ConstraintForm::stabilized_index_2};
  const Eigen::VectorXd values = values_of(*analyze(other, start_design(problem)));
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
  ProblemFile problem =
      quick_problem({R"(/scene/bodies/rod={"type": "beam", "from": [0.12, 0, 0], "to": [0.3, 0, 0],
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
}  // namespace pleuel::test::accuracy_test
