#include "optimization/design/design_solve.hpp"

#include <filesystem>

#include "core/base/eager_matrices.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/scene/problem_reader.hpp"
#include "optimization/backends.hpp"
#include "optimization/design/peak_problem.hpp"
#include "optimization/design/staged_solve.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/problems/loaded_crank.hpp"
#include "tests/support/files.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::design_solve_test {
namespace {

// What solve_design() makes of designs that are stationary and no optima, and of peaks that tie.

/// An arm of 100 mm, held at the angle phi: the place of its tip is 100 mm · cos phi, most at the
/// start.
const char* const arm = R"({
  "scene": {
    "bodies": {"arm": {"type": "beam", "from": [0, 0, 0], "to": ["100 mm", 0, 0], "rigid": true,
      "material": "steel", "elements": 2, "section": {"type": "circle", "diameter": "10 mm"}}},
    "joints": {"bearing": {"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0],
      "drive": {"type": "constant", "value": {"variable": "phi"}}}}},
  "simulation": {"end_time": "2 ms", "step": "1 ms"},
  "variables": {"phi": {"start": 0, "lower": -1, "upper": 1}},
  "responses": {"x": {"type": "position", "body": "arm", "at": 1, "direction": "x", "over_time": "final"}},
  "objective": {"minimize": "x"}})";

/// A block that swings by 100 mm about 20 mm + a: its greatest distance from the origin is
/// |20 mm + a| + 100 mm, where two peaks tie at a = −20 mm.
const char* const block = R"({
  "scene": {
    "bodies": {"block": {"type": "rigid", "at": ["20 mm", 0, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]}},
    "joints": {"guide": {"type": "prismatic", "bodies": ["ground", "block"], "at": ["20 mm", 0, 0],
      "axis": [1, 0, 0], "drive": {"type": "harmonic", "amplitude": "100 mm",
        "frequency": "628.3185307179586 rad/s", "offset": {"variable": "a"}}}}},
  "simulation": {"end_time": "10 ms", "step": "0.05 ms"},
  "variables": {"a": {"start": 0, "lower": "-50 mm", "upper": "50 mm"}},
  "responses": {"reach": {"type": "position", "body": "block", "direction": "x", "over_time": "max-abs"}},
  "objective": {"minimize": "reach"}})";

/// The lightest bar of 400 mm whose tip gives way by F L³/(3EI) under a force, of a rectangle of
/// 30 mm times h: with I = b h³/12, h³ = 4 F L³/(E b w).
ProblemFile bar_of(double height) {
  const double force = 2.1e11 * 0.03 * 5e-3 * std::pow(height / 0.4, 3) / 4.0;
  return read_problem_text(fmt::format(R"({{"scene": {{"gravity": [0, -0.1, 0],
        "materials": {{"steel": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
        "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [0.4, 0, 0],
          "material": "steel", "elements": 2,
          "section": {{"type": "rectangle", "width": 0.03, "height": {{"variable": "height"}}}}}}}},
        "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}},
        "loads": {{"press": {{"type": "force", "body": "bar", "at": [0.4, 0, 0],
          "direction": [0, 1, 0], "value": {}}}}}}},
      "simulation": {{"end_time": 1e-3, "step": 5e-4, "initial_state": "quasi-static"}},
      "variables": {{"height": {{"start": {}, "lower": 0.001, "upper": 0.5}}}},
      "responses": {{"mass": {{"type": "mass"}},
        "sag": {{"type": "deflection", "body": "bar", "at": 1, "over_time": "max-abs"}}}},
      "objective": {{"minimize": "mass"}},
      "constraints": {{"stiff": {{"response": "sag", "upper": 5e-3}}}}}})",
                                       force, 1.2 * height),
                           "bar.json")
      .complete();
}

/// Of half its length shear would change the deflection by some 16 %: an optimum by its numbers
/// only. That gravity is a hundredth of the usual is told first: a wrong unit would be the cause.
TEST(SolveDesign, OfNumbersThatAreNotToBeTrustedIsNotVerified) {
  EXPECT_NEAR(verified_optimum(bar_of(0.02)).x[0], 0.02, 1e-3 * 0.02);
  DesignProblem stubby(bar_of(0.2));
  const Result doubtful = solve_design(stubby, {});
  EXPECT_NEAR(doubtful.x[0], 0.2, 1e-3 * 0.2);
  EXPECT_EQ(doubtful.status, Status::unresolved) << doubtful.message;
  EXPECT_THAT(doubtful.message, HasSubstr("not to be trusted: \"bar\" is stubby"));
  ASSERT_EQ(doubtful.warnings.size(), 2u);
  EXPECT_THAT(doubtful.warnings[0], HasSubstr("/scene/gravity"));
  EXPECT_THAT(doubtful.warnings[1], HasSubstr("stubby"));
}

/// 90 mm are too few for a swing of 100 mm: the least that is missed is a ninth, at a = −20 mm. A
/// run that went on from elsewhere, and had one iteration left, answers with the best that was
/// seen.
TEST(SolveDesign, ThatProvesNothingEndsAtTheBestDesignOfTheWholeRun) {
  for (const std::string backend : {"nlopt-mma", "nlopt-slsqp"}) {
    DesignProblem problem(
        problem_from(block, {R"(/responses/mass={"type": "mass"})", "/objective/minimize=mass",
                             R"(/constraints={"narrow": {"response": "reach", "upper": "90 mm"}})",
                             "/simulation/resolution_check=false"}));
    const Result result = solve_design(problem, {.backend = backend, .max_iterations = 41});
    EXPECT_EQ(result.status, Status::infeasible) << backend << result.message;
    EXPECT_NEAR(result.max_violation, 1.0 / 9.0, 1e-5) << backend;
    EXPECT_NEAR(result.x[0], -0.02, 1e-6) << backend;
  }
}

class SolveDesign : public testing::TestWithParam<std::string> {};

TEST_P(SolveDesign, LeavesTheMaximumItStartsAt) {
  DesignProblem problem(problem_from(arm));
  const Result result = solve_design(problem, {.backend = GetParam()});
  EXPECT_EQ(to_string(result.status), "verified") << result.message;
  EXPECT_NEAR(result.evaluation.objective, 0.1 * std::cos(1.0), 1e-9);
}

TEST_P(SolveDesign, MinimizesTheHigherOneOfTwoPeaks) {
  DesignProblem problem(problem_from(block));
  const Result result = solve_design(problem, {.backend = GetParam()});
  EXPECT_EQ(to_string(result.status), "verified") << result.message;
  // Peaks of the parabola through three samples, 200 a period: (2π/200)⁴/64 · 100 mm at most.
  EXPECT_NEAR(result.evaluation.objective, 0.1, 1e-6);
  EXPECT_NEAR(result.x(0), -0.02, 1e-6);
  EXPECT_EQ(result.x.size(), 1);
  EXPECT_EQ(result.bound_multipliers.size(), 1);
}

INSTANTIATE_TEST_SUITE_P(Backends, SolveDesign, testing::ValuesIn(optimizer_names()),
                         name_of_backend);

/// Thirty-three periods: each of sixteen windows holds peaks of both sides.
TEST(SolveDesign, PartsTheTwoPeaksOfOnePeriod) {
  DesignProblem problem(
      problem_from(block, {"/simulation/end_time=330 ms", "/simulation/step=0.1 ms"}));
  const Result result = solve_design(problem, {.backend = "nlopt-slsqp"});
  EXPECT_EQ(to_string(result.status), "verified") << result.message;
  EXPECT_NEAR(result.x(0), -0.02, 1e-5);
  EXPECT_THAT(result.message, HasSubstr("told apart by 128 windows"));
}

TEST(SolveDesign, SaysWhenAndWhyItTellsPeaksApart) {
  DesignProblem problem(problem_from(block));
  std::vector<std::string> notices;
  int seen = 0;
  const Result result = solve_design(
      problem, {.backend = "nlopt-slsqp"},
      [&](const EvaluationRecord& record) {
        EXPECT_EQ(record.evaluation, ++seen);
        EXPECT_EQ(record.x.size(), 1);
        EXPECT_EQ(record.constraints.size(), 0);
        // The objective of the file, not its bound; samples 1.8° apart.
        EXPECT_NEAR(record.objective, std::abs(0.02 + record.x(0)) + 0.1, 1e-6);
        EXPECT_EQ(record.max_violation, 0.0);
      },
      [&](const std::string& notice) { notices.push_back(notice); });
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_THAT(notices[0], HasSubstr("two peaks tie in reach"));
  EXPECT_THAT(notices[0], HasSubstr("windows of time"));
  EXPECT_EQ(seen, result.evaluations);
  EXPECT_EQ(result.history.back().evaluation, seen);
  EXPECT_EQ(result.history.back().x.size(), 1);
}

/// No residual is below −1: nothing is verified, and the run ends at the kink. Budget and restarts
/// of the message are those of the whole run, whether it ends on the budget or before.
TEST(SolveDesign, NamesThePeaksThatTieWhereNothingIsVerified) {
  SolveOptions options{.backend = "nlopt-slsqp"};
  options.verdict.kkt_residual = -1.0;
  int used_up = 0, not_used_up = 0;
  for (options.max_iterations = 8; options.max_iterations < 64; options.max_iterations += 2) {
    DesignProblem problem(problem_from(block));
    bool goes_on = false;
    const Result result =
        solve_design(problem, options, {}, [&](const std::string&) { goes_on = true; });
    if (!goes_on || std::abs(result.x(0) + 0.02) > 1e-5) continue;
    EXPECT_EQ(to_string(result.status), "stalled");
    EXPECT_THAT(result.message, HasSubstr("two peaks tie in reach (at 0.00"));
    const bool is_used_up = result.iterations >= options.max_iterations;
    ++(is_used_up ? used_up : not_used_up);
    EXPECT_THAT(result.message,
                HasSubstr(is_used_up ? fmt::format("budget of {} iter", options.max_iterations)
                                     : fmt::format("after {} restarts", result.restarts)));
  }
  EXPECT_GT(used_up, 0);
  EXPECT_GT(not_used_up, 0);
}

/// 6.78248 N m by all three backends; what makes it an optimum is the audit.
TEST(SolveDesign, MinimizesTheDriveTorqueOfTheFourBar) {
  const auto path = std::filesystem::path(source_folder()) / "problems" / "four_bar.json";
  DesignProblem problem(read_problem(path, {"/objective/minimize=torque_peak"}).complete());
  const Result result = solve_design(problem, {.backend = "nlopt-slsqp"});
  EXPECT_EQ(to_string(result.status), "verified") << result.message;
  EXPECT_NEAR(result.evaluation.objective, 6.78248, 1e-3 * 6.78248);
}

/// The rows of the objective and t have the gradients of their windows.
TEST(PeakProblem, BoundsAnObjectiveThatIsAPeak) {
  DesignProblem problem(problem_from(block));
  PeakProblem peaks(problem, 4, Eigen::VectorXd::Constant(1, -0.01));
  ASSERT_EQ(peaks.variables().size(), 2u);
  EXPECT_NEAR(peaks.variables()[1].start, 0.11, 1e-6);
  const Eigen::Vector2d x(-0.01, 0.15);
  const Evaluation evaluation = peaks.evaluate(x, Request::values_and_gradients);
  EXPECT_EQ(evaluation.objective, 0.15);
  EXPECT_EQ(evaluation.objective_gradient, Eigen::Vector2d(0.0, 1.0));
  ASSERT_EQ(evaluation.constraints.size(), 4);
  // First quarter up to 0.01 + 0.1, last but one down to 0.01 − 0.1; below t = 0.15.
  EXPECT_NEAR(evaluation.constraints.maxCoeff(), -0.04, 1e-6);
  EXPECT_NEAR(evaluation.constraints.minCoeff(), -0.06, 1e-3);
  for (int row = 0; row < 4; ++row) {
    EXPECT_NEAR(std::abs(evaluation.constraint_jacobian(row, 0)), 1.0, 1e-9);
    EXPECT_EQ(evaluation.constraint_jacobian(row, 1), -1.0);
  }
  EXPECT_NEAR(peaks.fold_objective(0.15, evaluation.constraints), 0.11, 1e-6);
}

// Optimizations that choose their steps, elements and effects.

/// The optimum with all effects and steps of 25 µs, which three backends find (optimum_test.cpp)
/// [kg].
constexpr double known_optimum = 0.319445;

ProblemFile slider_crank(const std::vector<std::string>& overrides) {
  return read_problem(std::filesystem::path(source_folder()) / "problems" / "slider_crank.json",
                      overrides)
      .complete();
}

SolveOptions options_of(const ProblemFile& file) {
  SolveOptions options;
  options.backend = file.optimizer.backend;
  options.tolerance = file.optimizer.tolerance;
  options.max_iterations = file.optimizer.max_iterations;
  return options;
}

StagedSolution solve(const ProblemFile& file) {
  return solve_in_stages(file, start_design(file), {options_of(file)});
}

TEST(StagedSolve, BeginsCoarseAndKeepsItsTargetAtTheOptimum) {
  const ProblemFile file = slider_crank({"/accuracy/target=0.01"});
  const StagedSolution solution = solve(file);
  const Result& result = solution.result;
  EXPECT_EQ(result.status, Status::verified) << result.message;
  EXPECT_NEAR(result.evaluation.objective, known_optimum, 1e-2 * known_optimum);
  ASSERT_TRUE(result.error);
  EXPECT_LE(result.error->bound(), 1e-2 * known_optimum);
  ASSERT_GE(solution.stages.size(), 2u);
  EXPECT_GT(solution.stages.front().settings.front().step, 4.0 * file.simulation.step);
  EXPECT_LT(solution.stages.back().settings.front().step,
            solution.stages.front().settings.front().step);
}

TEST(StagedSolve, SaysOfEachEvaluationWhatItWasSimulatedWith) {
  const StagedSolution solution = solve(slider_crank({"/accuracy/target=0.01"}));
  const History& history = solution.result.history;
  std::size_t next = 0;
  double seconds = 0.0;
  for (const Stage& stage : solution.stages) {
    for (int i = 0; i < stage.evaluations; ++i, ++next) {
      ASSERT_LT(next, history.size());
      EXPECT_EQ(history[next].evaluation, static_cast<int>(next) + 1);
      EXPECT_EQ(history[next].time_step, stage.settings.front().step);
      EXPECT_EQ(history[next].elements, stage.settings.front().elements);
      EXPECT_GE(history[next].seconds, seconds);
      seconds = history[next].seconds;
    }
  }
  EXPECT_EQ(next, history.size());
  EXPECT_EQ(solution.result.evaluations, static_cast<int>(history.size()));
}

/// Without a target nothing is chosen: the file is solved as it is.
TEST(StagedSolve, TakesTheFileAsItIsWithoutATarget) {
  const ProblemFile file = slider_crank({"/simulation/step=2e-4"});
  const StagedSolution solution = solve(file);
  DesignProblem design(file);
  const Result plain = solve_design(design, options_of(file));
  EXPECT_EQ(solution.stages.size(), 1u);
  EXPECT_EQ(solution.result.x, plain.x);
  EXPECT_EQ(solution.result.evaluations, plain.evaluations);
  EXPECT_EQ(solution.result.restarts, plain.restarts);
  EXPECT_EQ(solution.result.history.front().time_step, 2e-4);
  EXPECT_EQ(solution.result.history.front().elements, 12);
}

/// Stiffening changes little of the heavy start, and the bow of the light rod by 6 %: without it
/// the optimum is 1.7 % too heavy.
TEST(StagedSolve, TakesEffectsBackThatMatterAtTheOptimum) {
  ProblemFile file =
      slider_crank({"/effects/tolerance=0.03", "/effects/geometric_stiffening=\"auto\""});
  decide_effects(file);
  DesignProblem lean(file);
  const Result without = solve_design(lean, options_of(file));
  EXPECT_EQ(without.status, Status::unresolved);
  EXPECT_GT(without.evaluation.objective, 1.01 * known_optimum);
  const StagedSolution solution = solve(file);
  EXPECT_EQ(solution.stages.size(), 2u);
  EXPECT_EQ(solution.result.status, Status::verified) << solution.result.message;
  EXPECT_NEAR(solution.result.evaluation.objective, known_optimum, 0.01 * known_optimum);
  ASSERT_TRUE(solution.result.error);
  EXPECT_GT(solution.result.error->effects.bound, 0.0);
  EXPECT_LE(std::abs(solution.result.evaluation.objective - known_optimum),
            solution.result.error->bound());
}

}  // namespace
}  // namespace pleuel::test::design_solve_test
