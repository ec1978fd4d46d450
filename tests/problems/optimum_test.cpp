#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/scene/problem_reader.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/design_solve.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/problems/loaded_crank.hpp"
#include "tests/support/files.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// Problems 21, 35, 37, 71 and 76 of W. Hock & K. Schittkowski, Test Examples for Nonlinear
/// Programming Codes, Springer 1981, with the optima of the book, written in the language of problem
/// files: objective and limits are formulas of the variables, and the mechanism is a stone that lies
/// on the floor.

namespace pleuel::test::optimum_test {
namespace {

// Every backend, from every start, must find the same optimum of the problem files.
//
// The masses are pinned from runs of all three backends, which agree to 1e-3 or better; that they
// are optima is not taken from those runs but from the audit (KKT conditions at the true limits,
// gradients against differences) that the status `verified` stands for. It is the
// same optimum from all of them: what steps and elements leave of it is judged once for each.

struct KnownProblem {
  const char* name;
  double mass;                              // of the optimum [kg]
  std::vector<std::vector<double>> starts;  // [m], in the order of the variables
};

const std::vector<KnownProblem>& known_problems() {
  static const std::vector<KnownProblem> problems = {
      {"slider_crank",
       0.319445,
       {{0.020, 0.030, 0.020, 0.030}, {0.040, 0.050, 0.030, 0.040}, {0.012, 0.016, 0.010, 0.012}}},
      {"slider_crank_round", 0.530613, {{0.030, 0.030}, {0.036, 0.024}, {0.018, 0.014}}},
      {"slider_crank_tapered",
       0.413156,
       {{0.030, 0.030, 0.030, 0.030, 0.030, 0.030, 0.030, 0.030},
        {0.040, 0.035, 0.030, 0.025, 0.020, 0.020, 0.020, 0.020},
        {0.022, 0.022, 0.022, 0.022, 0.014, 0.014, 0.014, 0.014}}},
      {"four_bar", 0.546644, {{0.020, 0.020, 0.020}, {0.008, 0.030, 0.010}}},
      {"spatial_slider_crank", 0.159635, {{0.020, 0.020, 0.012}, {0.012, 0.030, 0.020}}},
      {"robot_arm", 0.460676, {{0.060, 0.003, 0.050, 0.003}, {0.080, 0.002, 0.030, 0.005}}},
  };
  return problems;
}

struct Case {
  std::size_t problem, start;
  std::string backend;
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (std::size_t problem = 0; problem < known_problems().size(); ++problem) {
    for (std::size_t start = 0; start < known_problems()[problem].starts.size(); ++start) {
      for (const char* backend : {"nlopt-mma", "nlopt-slsqp", "ipopt"}) {
        cases.push_back({problem, start, backend});
      }
    }
  }
  return cases;
}

std::string name_of(const testing::TestParamInfo<Case>& info) {
  std::string name = fmt::format("{}_{}_start{}", known_problems()[info.param.problem].name,
                                 info.param.backend, info.param.start + 1);
  for (char& letter : name) {
    if (letter == '-') letter = '_';
  }
  return name;
}

class OptimumOfProblem : public testing::TestWithParam<Case> {};

TEST_P(OptimumOfProblem, IsFoundByEveryBackendFromEveryStart) {
  const KnownProblem& known = known_problems()[GetParam().problem];
  const auto path =
      std::filesystem::path(source_folder()) / "problems" / (std::string(known.name) + ".json");
  ProblemFile file = read_problem(path).complete();
  const std::vector<double>& start = known.starts[GetParam().start];
  ASSERT_EQ(start.size(), file.variables.size());
  for (std::size_t i = 0; i < start.size(); ++i) file.variables[i].start = start[i];
  file.simulation.checks_resolution = GetParam().start == 0 && GetParam().backend == "nlopt-slsqp";
  SolveOptions options;
  options.backend = GetParam().backend;
  options.tolerance = file.optimizer.tolerance;
  options.max_iterations = file.optimizer.max_iterations;
  DesignProblem problem(std::move(file));

  const Result result = solve_design(problem, options);

  EXPECT_EQ(to_string(result.status), "verified") << result.message;
  EXPECT_NEAR(result.evaluation.objective, known.mass, 1e-3 * known.mass);
  EXPECT_LE(result.max_violation, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(SliderCranks, OptimumOfProblem, testing::ValuesIn(all_cases()), name_of);

/// From here SLSQP steps onto the lower bounds first and loses its way (problems/README.md). It may
/// fail to find the optimum, but must not call anything else one; the others find it.
TEST(OptimumFromAHeavyStart, IsFoundOrNotCalledOne) {
  for (const char* backend : {"nlopt-mma", "nlopt-slsqp", "ipopt"}) {
    ProblemFile file = read_problem(std::filesystem::path(source_folder()) / "problems" /
                                    "slider_crank_round.json")
                           .complete();
    file.variables[0].start = 0.045;
    file.variables[1].start = 0.020;
    file.simulation.checks_resolution = false;
    DesignProblem problem(std::move(file));
    const Result result = solve_design(problem, {.backend = backend});
    const bool is_optimum = std::abs(result.evaluation.objective - 0.530613) <= 1e-3 * 0.530613;
    EXPECT_EQ(result.status == Status::verified, is_optimum) << backend << result.message;
    EXPECT_TRUE(is_optimum || std::string(backend) == "nlopt-slsqp") << backend;
    EXPECT_LE(result.max_violation, 1e-4) << backend;
  }
}

/// Where two supports of a bar under its own weight bend it least: M over a support, q a²/2, is then M
/// in the middle, q L (L/4 − a)/2, so a = (√2 − 1) L/2.
TEST(MovingSupports, AreFoundWhereTheyBendLeast) {
  const ProblemFile problem = problem_from(R"({"scene": {"gravity": [0, "-9.81 m/s^2", 0],
    "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [2, 0, 0], "material": "steel", "elements": 8,
      "section": {"type": "rectangle", "width": "40 mm", "height": "20 mm"}}},
    "joints": {
      "left": {"type": "revolute", "bodies": ["ground", "bar"], "at": [{"variable": "a"}, 0, 0]},
      "right": {"type": "point-on-line", "bodies": ["ground", "bar"], "at": ["= 2 m - a", 0, 0],
                "axis": [1, 0, 0]}}},
  "simulation": {"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static"},
  "variables": {"a": {"start": "0.2 m", "lower": "0.05 m", "upper": "0.9 m"}},
  "responses": {"stress": {"type": "stress", "body": "bar", "over_time": "max"}},
  "objective": {"minimize": "stress"}})");
  const Result result = verified_optimum(problem);
  const double a = std::sqrt(2.0) - 1.0;
  EXPECT_NEAR(result.x(0), a, 1e-5);
  const double q = 7850 * 0.04 * 0.02 * 9.81;
  const double stress = 6 * (q * a * a / 2) / (0.04 * 0.02 * 0.02);
  EXPECT_NEAR(result.evaluation.objective, stress, 1e-4 * stress);
}

using Json = nlohmann::ordered_json;

struct Range {
  double start, lower, upper;
};
struct Limit {
  const char* formula;
  const char* side;
  double value;
};

struct TextbookProblem {
  std::string name;
  const char* aim;
  const char* objective;
  std::vector<Range> variables;  ///< x1, x2, …
  std::vector<Limit> limits;
  double optimum;
  std::vector<double> design;
};

void PrintTo(const TextbookProblem& problem, std::ostream* stream) {
  *stream << problem.name;
}

Json document_of(const TextbookProblem& problem) {
  Json document = Json::parse(R"({
    "scene": {"bodies": {"stone": {"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]}},
              "joints": {"floor": {"type": "fixed", "bodies": ["ground", "stone"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": "2 s", "step": "1 s"}, "constraints": {}})");
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const Range& range = problem.variables[i];
    document["variables"]["x" + std::to_string(i + 1)] = {
        {"start", range.start}, {"lower", range.lower}, {"upper", range.upper}};
  }
  document["responses"]["f"] = {{"type", "expression"}, {"value", problem.objective}};
  document["objective"] = {{problem.aim, "f"}};
  for (std::size_t i = 0; i < problem.limits.size(); ++i) {
    const Limit& limit = problem.limits[i];
    document["constraints"]["c" + std::to_string(i + 1)] = {
        {"response", std::string("= ") + limit.formula}, {limit.side, limit.value}};
    if (limit.side == std::string("both")) {
      document["constraints"]["c" + std::to_string(i + 1)] = {
          {"response", std::string("= ") + limit.formula},
          {"lower", limit.value},
          {"upper", limit.value}};
    }
  }
  return document;
}

class HockSchittkowski : public testing::TestWithParam<TextbookProblem> {};

TEST_P(HockSchittkowski, HasItsOptimumInTheLanguageOfProblemFiles) {
  const TextbookProblem& problem = GetParam();
  DesignProblem design(
      read_problem_text(document_of(problem).dump(), problem.name + ".json").complete());
  const Result result = verified(solve_design(design, {}));
  // Optima are flat: a design to 1e-4 has its value to 1e-8.
  EXPECT_NEAR(design.objective_sign() * result.evaluation.objective, problem.optimum,
              1e-5 * std::abs(problem.optimum));
  for (std::size_t i = 0; i < problem.design.size(); ++i) {
    EXPECT_NEAR(result.x(i), problem.design[i], 1e-3 * (1.0 + std::abs(problem.design[i])))
        << "x" << i + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(
    TestExamples, HockSchittkowski,
    testing::Values(
        // The start of the book, (−1, −1), is outside its bounds.
        TextbookProblem{"HS21",
                        "minimize",
                        "0.01*x1^2 + x2^2 - 100",
                        {{10, 2, 50}, {-1, -50, 50}},
                        {{"10*x1 - x2 - 10", "lower", 0}},
                        -99.96,
                        {2, 0}},
        TextbookProblem{"HS35",
                        "minimize",
                        "9 - 8*x1 - 6*x2 - 4*x3 + 2*x1^2 + 2*x2^2 + x3^2 + 2*x1*x2 + 2*x1*x3",
                        {{0.5, 0, 10}, {0.5, 0, 10}, {0.5, 0, 10}},
                        {{"x1 + x2 + 2*x3", "upper", 3}},
                        1.0 / 9.0,
                        {4.0 / 3.0, 7.0 / 9.0, 4.0 / 9.0}},
        TextbookProblem{"HS37",  // of the book: minimize −x1 x2 x3
                        "maximize",
                        "x1*x2*x3",
                        {{10, 0, 42}, {10, 0, 42}, {10, 0, 42}},
                        {{"x1 + 2*x2 + 2*x3", "upper", 72}, {"x1 + 2*x2 + 2*x3", "lower", 0}},
                        3456,
                        {24, 12, 12}},
        TextbookProblem{"HS71",
                        "minimize",
                        "x1*x4*(x1 + x2 + x3) + x3",
                        {{1, 1, 5}, {5, 1, 5}, {5, 1, 5}, {1, 1, 5}},
                        {{"x1*x2*x3*x4", "lower", 25}, {"x1^2 + x2^2 + x3^2 + x4^2", "both", 40}},
                        17.0140173,
                        {1, 4.7429994, 3.8211503, 1.3794082}},
        TextbookProblem{"HS76",
                        "minimize",
                        "x1^2 + 0.5*x2^2 + x3^2 + 0.5*x4^2 - x1*x3 + x3*x4 - x1 - 3*x2 + x3 - x4",
                        {{0.5, 0, 10}, {0.5, 0, 10}, {0.5, 0, 10}, {0.5, 0, 10}},
                        {{"x1 + 2*x2 + x3 + x4", "upper", 5},
                         {"3*x1 + x2 + 2*x3 - x4", "upper", 4},
                         {"x2 + 4*x3", "lower", 1.5}},
                        -4.681818181,
                        {0.2727273, 2.090909, 0.0, 0.5454545}}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace pleuel::test::optimum_test
