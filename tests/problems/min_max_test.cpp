#include <filesystem>

#include "core/base/eager_matrices.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/scene/response_parts.hpp"
#include "optimization/backends.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/peak_problem.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/support/files.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::min_max_test {
namespace {

// The largest of several responses, as an objective and as a limit.

/// A rigid bar of 1 m, and the formulas f = (p − 0.3 m)² + q², g = (p + 0.2 m)² + q² + 0.1 m².
ProblemFile bar(const std::string& goals) {
  return problem_from(
      R"({"scene": {"bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
    "rigid": true, "material": "steel", "elements": 1, "section": {"type": "circle", "diameter": "10 mm"}}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}},
  "simulation": {"end_time": "2 ms", "step": "1 ms", "resolution_check": false},
  "variables": {"p": {"start": "0.8 m", "lower": "-1 m", "upper": "1 m"},
                "q": {"start": "0.5 m", "lower": "-1 m", "upper": "1 m"}},
  "responses": {"f": {"type": "expression", "value": "(p - 0.3 m)^2 + q^2"},
                "g": {"type": "expression", "value": "(p + 0.2 m)^2 + q^2 + 0.1 m^2"},
                "x": {"type": "position", "body": "bar", "at": 1, "direction": "x", "over_time": "max"}},)" +
      goals + "}");
}

/// f = g where −0.6 p + 0.09 = 0.4 p + 0.14: p = −0.05 m; there both are 0.1225 m². The larger one is
/// convex, and its slopes ∂f/∂p = −0.7, ∂g/∂p = 0.3 differ in sign: that is the minimum.
constexpr double best_p = -0.05, best_value = 0.1225;

Result optimized(const ProblemFile& file, const std::string& backend = "nlopt-slsqp") {
  DesignProblem design(file);
  SolveOptions options{.backend = backend};
  return solve_design(design, options);
}

TEST(MinMax, MeetsTheKinkOfTheLargestResponse) {
  for (const std::string& backend : optimizer_names()) {
    const Result result = optimized(bar(R"j("objective": {"minimize": "= max(f, g)"})j"), backend);
    EXPECT_EQ(result.status, Status::verified) << backend << ": " << result.message;
    EXPECT_NEAR(result.evaluation.objective, best_value, 1e-4 * best_value) << backend;
    EXPECT_NEAR(result.x(0), best_p, 1e-3) << backend;
    EXPECT_NEAR(result.x(1), 0.0, 1e-2) << backend;
  }
}

TEST(MinMax, MaximizesTheSmallestAlike) {
  const Result result =
      verified(optimized(bar(R"j("objective": {"maximize": "= min(1 m^2 - f, 1 m^2 - g)"})j")));
  EXPECT_NEAR(-result.evaluation.objective, 1.0 - best_value, 1e-4);
}

TEST(MinMax, OfFormulasMakesResponsesOfThem) {
  const ProblemFile file = bar(R"j("objective": {"minimize": "= max(2*f, g + f, f)"})j");
  std::vector<std::string> names;
  for (const ResponseSettings& response : file.responses) names.push_back(response.name);
  EXPECT_THAT(names, ElementsAre("f", "g", "x", "2*f", "g + f", "max(2*f, g + f, f)"));
  EXPECT_EQ(file.objective->response, "max(2*f, g + f, f)");
  EXPECT_EQ(extreme_parts(file, 5, Extreme::largest), (std::vector<std::size_t>{0, 3, 4}));
  EXPECT_TRUE(extreme_parts(file, 5, Extreme::smallest).empty());
}

TEST(MinMax, OfMoreThanAnExtremeIsNotSplit) {
  EXPECT_EQ(bar(R"j("objective": {"minimize": "= max(f, g) + f"})j").responses.size(), 4u);
  // A number among them has no gradient.
  EXPECT_EQ(bar(R"j("objective": {"minimize": "= max(f, 0.2 m^2)"})j").responses.size(), 4u);
}

TEST(MinMax, LimitsEachOfItsParts) {
  // The smallest p with f and g at most 0.2 m²: g = 0.2 is p = −0.2 − √0.1, where f is too large;
  // f = 0.2 is p = 0.3 − √0.2, where g is 0.1 + (0.5 − √0.2)² < 0.2.
  const ProblemFile file = bar(R"j("objective": {"minimize": "= p"},
    "constraints": {"both": {"response": "= max(f, g)", "upper": "0.2 m^2"}})j");
  DesignProblem design(file);
  PeakProblem peaks(design, 4);
  EXPECT_EQ(peaks.constraints().size(), 2u);
  const Result result = verified(optimized(file));
  EXPECT_NEAR(result.x(0), 0.3 - std::sqrt(0.2), 1e-4);
}

TEST(MinMax, HasTheGradientsOfItsParts) {
  DesignProblem design(bar(R"j("objective": {"minimize": "= max(f, x*x)"})j"));
  PeakProblem peaks(design, 2);
  // x*x is an expression, f another: two rows, and the bound.
  ASSERT_EQ(peaks.constraints().size(), 2u);
  const Eigen::VectorXd x = Eigen::Vector3d(0.4, 0.3, 0.0);
  const Evaluation at = peaks.evaluate(x, Request::values_and_gradients);
  EXPECT_NEAR(at.constraints(0), 0.01 + 0.09, 1e-12);
  EXPECT_NEAR(at.constraints(1), 1.0, 1e-9);
  EXPECT_NEAR(at.constraint_jacobian(0, 0), 2.0 * 0.1, 1e-12);
  EXPECT_NEAR(at.constraint_jacobian(0, 1), 2.0 * 0.3, 1e-12);
  EXPECT_EQ(at.constraint_jacobian(0, 2), -1.0);
}

/// A limit on the smallest value over time from above is none on each window of time.
TEST(PeakProblem, LeavesAMinimumWithAnUpperLimitWhole) {
  ProblemFile file = bar(R"j("objective": {"minimize": "f"},
    "constraints": {"low": {"response": "x", "upper": "2 m"}})j");
  const auto rows_with = [&](OverTime over_time, bool is_upper) {
    file.responses[2].over_time = over_time;
    file.constraints[0].upper = is_upper ? std::optional(2.0) : std::nullopt;
    file.constraints[0].lower = is_upper ? std::nullopt : std::optional(0.1);
    DesignProblem design(file);
    return PeakProblem(design, 2).constraints().size();
  };
  EXPECT_EQ(rows_with(OverTime::max, true), 2u);
  EXPECT_EQ(rows_with(OverTime::min, false), 2u);
  EXPECT_EQ(rows_with(OverTime::min, true), 1u);
  EXPECT_EQ(rows_with(OverTime::max, false), 1u);
  EXPECT_EQ(rows_with(OverTime::max_abs, true), 2u);
}

/// A quick variant of a problem file: coarse, and over in 20 ms.
ProblemFile quick_problem(const char* name, std::vector<std::string> overrides = {}) {
  const auto path =
      std::filesystem::path(source_folder()) / "problems" / (std::string(name) + ".json");
  for (const char* quick : {"/simulation/step=0.2 ms", "/simulation/end_time=20 ms",
                            R"(/pareto={"responses": ["crank_and_rod", "rod_bow"]})",
                            "/scene/joints/bearing/drive/ramp=20 ms"}) {
    overrides.push_back(quick);
  }
  return read_problem(path, overrides).complete();
}

TEST(PeakProblem, FoldsToTheConstraintsOfTheFile) {
  DesignProblem problem(quick_problem("slider_crank"));
  PeakProblem peaks(problem, 16);
  const Eigen::VectorXd x = start_design(problem.file());
  const Evaluation whole = problem.evaluate(x, Request::values);
  const Evaluation rows = peaks.evaluate(x, Request::values);
  EXPECT_GT(rows.constraints.size(), whole.constraints.size());
  const Eigen::VectorXd folded = peaks.fold_values(rows.constraints);
  for (Eigen::Index i = 0; i < folded.size(); ++i) {
    EXPECT_EQ(folded(i), whole.constraints(i)) << problem.constraints()[std::size_t(i)].name;
  }
}

/// The gradient of a whole maximum is that of its highest window.
TEST(PeakProblem, HasTheGradientOfTheWholeInItsWorstRow) {
  DesignProblem problem(quick_problem("slider_crank_round"));
  PeakProblem peaks(problem, 16);
  const Eigen::VectorXd x = 0.8 * start_design(problem.file());
  const Evaluation whole = problem.evaluate(x, Request::values_and_gradients);
  const Evaluation rows = peaks.evaluate(x, Request::values_and_gradients);
  const auto& constraint_of_row = peaks.constraint_of_row();
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto count =
        Eigen::Index(std::count(constraint_of_row.begin(), constraint_of_row.end(), i));
    Eigen::Index worst = 0;
    rows.constraints.segment(first, count).maxCoeff(&worst);
    EXPECT_EQ(rows.constraint_jacobian.row(first + worst),
              whole.constraint_jacobian.row(Eigen::Index(i)));
    first += count;
  }
  EXPECT_EQ(first, rows.constraints.size()) << "all four limits are on peaks";
}

/// Differences of each window's peak: those of the exact method, to their truncation.
TEST(PeakProblem, HasTheGradientsOfDifferencesIfAsked) {
  ProblemFile file = quick_problem("slider_crank_round");
  DesignProblem exact(file);
  file.sensitivity.method = GradientMethod::central_difference;
  DesignProblem differenced(file, 2);
  PeakProblem peaks(exact, 16), differenced_peaks(differenced, 16);
  const Eigen::VectorXd x = 0.8 * start_design(file);
  const Evaluation expected = peaks.evaluate(x, Request::values_and_gradients);
  const Evaluation found = differenced_peaks.evaluate(x, Request::values_and_gradients);
  EXPECT_EQ(differenced.method()->method, GradientMethod::central_difference);
  EXPECT_EQ(found.constraints, expected.constraints);
  const auto compare = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    EXPECT_LE((a - b).lpNorm<Eigen::Infinity>(), 1e-5 * b.lpNorm<Eigen::Infinity>());
    EXPECT_GT((a - b).lpNorm<Eigen::Infinity>(), 0.0);
  };
  compare(found.constraint_jacobian, expected.constraint_jacobian);
  compare(found.objective_gradient, expected.objective_gradient);
}

TEST(PeakProblem, AddsTheMultipliersOfTheRowsOfAConstraint) {
  DesignProblem problem(quick_problem("slider_crank_round"));
  PeakProblem peaks(problem, 16);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(Eigen::Index(peaks.constraints().size()));
  // 16 windows; of the stress of one segment, at four stretches of it.
  EXPECT_EQ(peaks.fold_multipliers(ones), Eigen::Vector4d(64.0, 64.0, 16.0, 16.0));
}

/// Of what a formula has with a number as its factor: the factor decides which peaks are pressed upon.
TEST(PeakProblem, DividesThePeaksInAFormula) {
  const auto rows_of = [](const std::string& limit) {
    DesignProblem problem(
        quick_problem("slider_crank_round", {R"(/objective={"minimize": "crank_and_rod"})",
                                             "/constraints={\"rod_stiffness\": " + limit + "}"}));
    PeakProblem peaks(problem, 16);
    const Eigen::VectorXd x = 0.8 * start_design(problem.file());
    return peaks.evaluate(x, Request::values_and_gradients);
  };
  const Evaluation plain = rows_of(R"({"response": "rod_stress", "upper": "1 GPa"})");
  const Eigen::Index count = plain.constraints.size();
  EXPECT_GT(count, 16);
  const auto compare = [&](const std::string& limit, double factor, double constant) {
    const Evaluation found = rows_of(limit);
    ASSERT_EQ(found.constraints.size(), count) << limit;
    for (Eigen::Index i = 0; i < count; ++i) {
      const double expected = factor * plain.constraints(i) + constant;
      EXPECT_NEAR(found.constraints(i), expected, 1e-12 * std::abs(expected)) << limit;
    }
    const Eigen::MatrixXd expected = factor * plain.constraint_jacobian;
    EXPECT_LE((found.constraint_jacobian - expected).norm(), 1e-12 * expected.norm()) << limit;
  };
  compare(R"({"response": "= 3*rod_stress - 5 MPa", "upper": "1 GPa"})", 3.0, -5e6);
  compare(R"({"response": "= (1 GPa - rod_stress)/2", "lower": "0 Pa"})", -0.5, 0.5e9);
  // Two of them: all pairs.
  const auto limited = [](const std::string& formula) {
    return R"({"response": ")" + formula + R"(", "upper": "1 GPa"})";
  };
  EXPECT_GT(rows_of(limited("= rod_stress + 2*rod_bow*(1 MPa/mm)")).constraints.size(), count);
  for (const std::string& limit :
       {std::string(R"({"response": "= 3*rod_stress", "lower": "1 Pa"})"),
        limited("= rod_stress^2/(1 MPa)"), limited("= rod_stress*(crank_and_rod/(1 kg))")}) {
    EXPECT_EQ(rows_of(limit).constraints.size(), 1) << limit;
  }
}

/// A factor changes no optimum.
TEST(SolveDesign, MinimizesAPeakInAFormulaAsThePeakItself) {
  const auto best = [](const std::string& objective) {
    DesignProblem problem(quick_problem(
        "slider_crank_round",
        {R"(/objective={"minimize": ")" + objective + R"("})",
         R"(/constraints={"rod_stiffness": {"response": "crank_and_rod", "upper": "0.5 kg"}})"}));
    const Result result = solve_design(problem, {.backend = "nlopt-slsqp"});
    EXPECT_EQ(to_string(result.status), "verified") << objective << ": " << result.message;
    return result.evaluation.objective;
  };
  const double plain = best("rod_stress");
  EXPECT_NEAR(best("= 2*rod_stress"), 2.0 * plain, 1e-4 * plain);
  EXPECT_NEAR(best("= rod_stress + crank_and_rod*(1e-3 Pa/kg)"), plain, 1e-4 * plain);
}

/// Sixteen rows for each limit from the beginning mislead SLSQP here into an infeasible design.
TEST(SolveDesign, SplitsNoLimitsWhereTheOptimumIsSmooth) {
  DesignProblem problem(quick_problem("slider_crank_round"));
  const Result result = solve_design(problem, {.backend = "nlopt-slsqp"});
  EXPECT_EQ(to_string(result.status), "verified") << result.message;
  EXPECT_EQ(result.restarts, 0);
}

}  // namespace
}  // namespace pleuel::test::min_max_test
