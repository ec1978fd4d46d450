#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "known_problems.hpp"
#include "optimization/backends.hpp"
#include "optimization/solve.hpp"

namespace pleuel::test::input_test {
namespace {

/// What solve() complains about.
std::string complaint(FunctionProblem problem, const std::string& backend = "nlopt-slsqp") {
  try {
    solve(problem, {.backend = backend});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

FunctionProblem with_first_variable(const Variable& variable) {
  const FunctionProblem cantilever_problem = cantilever().problem;
  std::vector<Variable> variables = cantilever_problem.variables();
  variables[0] = variable;
  return {variables, cantilever_problem.constraints(), [](const Eigen::VectorXd&, Request) {
            ADD_FAILURE() << "bad input was evaluated";
            return Evaluation{};
          }};
}

TEST(Input, AnUnknownBackendIsAnsweredWithTheNamesThereAre) {
  EXPECT_EQ(complaint(cantilever().problem, "nlopt-mna"),
            "there is no optimizer backend \"nlopt-mna\"; known are nlopt-mma, nlopt-ccsaq, "
            "nlopt-slsqp, ipopt");
}

TEST(Input, AStartOutsideItsBoundsIsNamed) {
  EXPECT_EQ(complaint(with_first_variable({"width", 12.0, 1.0, 10.0})),
            "variable width: the start 12 lies outside its bounds [1, 10]");
}

TEST(Input, AStartOutsideItsBoundsByRoundingIsMovedOntoThem) {
  KnownProblem known = cantilever();
  std::vector<Variable> variables = known.problem.variables();
  variables[0].start = 10.0 * (1.0 + 1e-15);
  const FunctionProblem problem(variables, known.problem.constraints(), {});
  EXPECT_EQ(checked_start(problem)[0], 10.0);
}

TEST(Input, ContradictoryBoundsAreNamed) {
  EXPECT_EQ(complaint(with_first_variable({"width", 5.0, 6.0, 4.0})),
            "variable width: the lower limit 6 must not exceed the upper limit 4");
}

TEST(Input, AStartThatIsNotANumberIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(complaint(with_first_variable({"width", nan, 1.0, 10.0})),
              testing::HasSubstr("variable width: the start nan"));
}

TEST(Input, ContradictoryLimitsAreNamed) {
  const FunctionProblem problem(cantilever().problem.variables(), {{"sag", 2.0, 1.0}}, {});
  EXPECT_EQ(complaint(problem),
            "constraint sag: the lower limit 2 must not exceed the upper limit 1");
}

TEST(Input, WithoutVariablesThereIsNothingToOptimize) {
  EXPECT_THAT(complaint(FunctionProblem({}, {}, {})), testing::HasSubstr("no variables"));
}

TEST(Input, WithAllVariablesFixedTheStartIsJudgedAsItIs) {
  KnownProblem known = cantilever();
  std::vector<Variable> variables = known.problem.variables();
  for (Variable& variable : variables) variable = {variable.name, 6.0, 6.0, 6.0};
  for (const std::string& backend : optimizer_names()) {
    FunctionProblem problem(variables, known.problem.constraints(),
                            [&](const Eigen::VectorXd& x, Request request) {
                              return known.problem.evaluate(x, request);
                            });
    const Result result = solve(problem, {.backend = backend});
    EXPECT_EQ(result.status, Status::verified) << result.message;
    EXPECT_EQ(result.x, Eigen::VectorXd::Constant(5, 6.0));
    EXPECT_EQ(result.evaluations, 1);
  }
}

}  // namespace
}  // namespace pleuel::test::input_test
