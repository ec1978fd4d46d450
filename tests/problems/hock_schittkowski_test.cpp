#include <nlohmann/json.hpp>

#include "core/scene/problem_reader.hpp"
#include "optimization/design/design_solve.hpp"
#include "tests/support/test.hpp"

/// Problems 21, 35, 37, 71 and 76 of W. Hock & K. Schittkowski, Test Examples for Nonlinear
/// Programming Codes, Springer 1981, with the optima of the book, written in the language of problem
/// files: objective and limits are formulas of the variables, and the mechanism is a stone that lies
/// on the floor.
namespace pleuel::test::hock_schittkowski_test {
namespace {

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
    "scene": {"bodies": {"stone": {"type": "rigid", "at": [0, 0, 0], "mass": 1,
                                   "inertia": [1, 1, 1, 0, 0, 0]}},
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
  const Result result = solve_design(design, {});
  EXPECT_EQ(result.status, Status::verified) << result.message;
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
}  // namespace pleuel::test::hock_schittkowski_test
