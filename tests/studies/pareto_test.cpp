#include "studies/pareto.hpp"

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "optimization/design_problem.hpp"
#include "optimization/design_solve.hpp"
#include "tests/studies/quick_problem.hpp"

namespace pleuel {
namespace {

const std::vector<std::string> four_points = {"/pareto/points=4"};

std::vector<ParetoPoint> front(const ProblemFile& problem) {
  SolveOptions options;
  options.backend = problem.optimizer.backend;
  return pareto_front(problem, options);
}

TEST(Pareto, MoreRoomNeverCostsMass) {
  const std::vector<ParetoPoint> points = front(test::quick_problem(four_points));
  ASSERT_EQ(points.size(), 4u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(points[i].result.status, Status::verified) << points[i].result.message;
    EXPECT_FALSE(points[i].is_dominated);
    if (i == 0) continue;
    EXPECT_GT(points[i].limit, points[i - 1].limit);
    // 1e-6 is the tolerance of the optimizer.
    EXPECT_LE(points[i].result.evaluation.objective,
              points[i - 1].result.evaluation.objective * (1 + 1e-6));
  }
}

TEST(Pareto, FirstPointIsTheOptimumOfTheProblemWithThatLimit) {
  const ProblemFile problem = test::quick_problem(four_points);
  ProblemFile limited = problem;
  for (ConstraintSettings& constraint : limited.constraints) {
    if (constraint.name == problem.pareto->constraint) constraint.upper = problem.pareto->from;
  }
  DesignProblem design_problem(limited);
  SolveOptions options;
  options.backend = problem.optimizer.backend;
  const Result alone = solve_design(design_problem, options);
  EXPECT_DOUBLE_EQ(front(problem).front().result.evaluation.objective, alone.evaluation.objective);
}

TEST(Pareto, EachPointStartsFromTheOptimumBefore) {
  const std::vector<ParetoPoint> points = front(test::quick_problem(four_points));
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_EQ(points[i].result.history.front().x, points[i - 1].result.x);
  }
}

TEST(Pareto, MultiplierIsTheSlopeOfTheFront) {
  const ProblemFile problem =
      test::quick_problem({"/pareto/points=3", "/pareto/from=0.02 mm", "/pareto/to=0.0202 mm"});
  const std::vector<ParetoPoint> points = front(problem);
  ASSERT_GT(points[1].multiplier, 0.0) << "the limit is not active: the test says nothing";
  const double slope =
      (points[2].result.evaluation.objective - points[0].result.evaluation.objective) /
      (points[2].limit - points[0].limit);
  // Central difference over 1 %: its error is of second order, well below 1e-2.
  EXPECT_NEAR(-slope / points[1].multiplier, 1.0, 1e-2);
}

TEST(Pareto, EqualDesignsDoNotDominateEachOther) {
  // At five metres the limit plays no part: both points are the same design.
  const ProblemFile problem =
      test::quick_problem({"/pareto/points=2", "/pareto/from=5 m", "/pareto/to=6 m"});
  for (const ParetoPoint& point : front(problem)) {
    EXPECT_FALSE(point.is_dominated);
    EXPECT_EQ(point.multiplier, 0.0);
  }
}

TEST(Pareto, WithoutSettingsThereIsNothingToVary) {
  ProblemFile problem = test::quick_problem();
  problem.pareto.reset();
  EXPECT_THROW(pareto_front(problem, {}), InputError);
}

}  // namespace
}  // namespace pleuel
