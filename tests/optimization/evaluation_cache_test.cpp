#include "optimization/evaluation_cache.hpp"

#include "core/base/eager_matrices.hpp"
#include "optimization/result.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::evaluation_cache_test {
namespace {

/// x² with the limit x ≤ 1, which cannot be evaluated below −5, and has no gradients below −2.
class CacheOfEvaluations : public testing::Test {
 protected:
  CacheOfEvaluations()
      : problem_({{"x", 3.0, -10.0, 10.0}}, {{"limit", -infinity, 1.0}},
                 [this](const Eigen::VectorXd& x, Request request) {
                   requests_.push_back(request);
                   if (x(0) < -5.0) throw EvaluationFailure("too far");
                   const bool with_gradients = request == Request::values_and_gradients;
                   if (with_gradients && x(0) < -2.0) throw EvaluationFailure("no gradients");
                   Evaluation evaluation;
                   evaluation.objective = x(0) * x(0);
                   evaluation.constraints = x;
                   if (!with_gradients) return evaluation;
                   evaluation.objective_gradient = 2.0 * x;
                   evaluation.constraint_jacobian = Eigen::MatrixXd::Ones(1, 1);
                   return evaluation;
                 }),
        start_{Eigen::VectorXd::Constant(1, 3.0), {}, 2.0},
        cache_(make_cache()) {}

  EvaluationCache make_cache() {
    start_.evaluation = problem_.evaluate(start_.x, Request::values_and_gradients);
    requests_.clear();
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(1);
    return EvaluationCache(problem_, start_, {2.0 * ones, ones}, {});
  }

  const Evaluation* at(double x, Request request) {
    return cache_.evaluate(Eigen::VectorXd::Constant(1, x), request);
  }

  std::vector<Request> requests_;  ///< that reached the problem
  FunctionProblem problem_;
  EvaluatedDesign start_;
  EvaluationCache cache_;
};

TEST_F(CacheOfEvaluations, AsksOnceForADesign) {
  ASSERT_NE(at(2.0, Request::values_and_gradients), nullptr);
  EXPECT_EQ(at(2.0, Request::values)->objective, 4.0);
  EXPECT_EQ(at(2.0, Request::values_and_gradients)->objective_gradient(0), 4.0);
  EXPECT_EQ(at(3.0, Request::values_and_gradients)->objective, 9.0);  // the start
  EXPECT_EQ(requests_.size(), 1u);
  EXPECT_EQ(cache_.evaluations(), 2);
}

TEST_F(CacheOfEvaluations, AsksAgainForGradientsThatItHasNot) {
  EXPECT_FALSE(at(2.0, Request::values)->has_gradients());
  EXPECT_TRUE(at(2.0, Request::values_and_gradients)->has_gradients());
  EXPECT_EQ(requests_.size(), 2u);
  EXPECT_EQ(cache_.gradient_evaluations(), 2);
}

TEST_F(CacheOfEvaluations, RemembersTheLatestDesignsOnly) {
  for (int i = 0; i < 9; ++i) at(0.1 * i, Request::values);
  EXPECT_EQ(requests_.size(), 9u);
  at(0.1 * 8, Request::values);
  at(0.1 * 1, Request::values);
  EXPECT_EQ(requests_.size(), 9u);
  at(0.0, Request::values);
  EXPECT_EQ(requests_.size(), 10u);
}

TEST_F(CacheOfEvaluations, RecordsFailuresWithTheirReason) {
  EXPECT_EQ(at(-6.0, Request::values), nullptr);
  EXPECT_EQ(at(-6.0, Request::values_and_gradients), nullptr);  // not tried again
  EXPECT_EQ(requests_.size(), 1u);
  EXPECT_EQ(cache_.history().back().failure, "too far");
  EXPECT_EQ(cache_.consecutive_failures(), 1);
  at(1.0, Request::values);
  EXPECT_EQ(cache_.consecutive_failures(), 0);
}

/// So that a backend does not accept a design that it then has no gradients of.
TEST_F(CacheOfEvaluations, TriesValuesWithGradientsOnceThoseFailedAlone) {
  ASSERT_NE(at(-3.0, Request::values), nullptr);
  EXPECT_EQ(at(-3.0, Request::values_and_gradients), nullptr);
  EXPECT_EQ(at(-2.5, Request::values), nullptr);
  EXPECT_EQ(requests_.back(), Request::values_and_gradients);
}

TEST_F(CacheOfEvaluations, RecordsStepsAndViolationsInTheirScales) {
  at(1.5, Request::values);
  const EvaluationRecord& record = cache_.history().back();
  EXPECT_EQ(record.evaluation, 2);
  EXPECT_DOUBLE_EQ(record.step, 1.5 / 2.0);
  EXPECT_DOUBLE_EQ(record.max_violation, 0.5);
}

TEST_F(CacheOfEvaluations, CountsIterationsOfTheSearchButNotOfAudits) {
  const int before = cache_.iterations();
  at(1.0, Request::values_and_gradients);
  at(0.5, Request::values);
  cache_.set_purpose(Purpose::audit);
  at(0.7, Request::values_and_gradients);
  EXPECT_EQ(cache_.iterations(), before + 1);
}

EvaluationRecord record(double objective, double max_violation, const std::string& failure = "") {
  EvaluationRecord record;
  record.objective = objective;
  record.max_violation = max_violation;
  record.failure = failure;
  return record;
}

TEST(BestRecord, IsTheLowestOneWithinTheLimits) {
  const History history = {record(5, 0), record(1, 1e-2), record(3, 1e-5), record(4, 0),
                           record(0, 0, "it cannot be simulated")};
  EXPECT_EQ(best_record(history, 1e-4).objective, 3);
  EXPECT_EQ(best_record(history, 1e-6).objective, 4);
}

TEST(BestRecord, IsTheOneNearestToTheLimitsIfNoneKeepsThem) {
  const History history = {record(1, 0.3), record(5, 0.1), record(2, 0.2), record(9, 0.0, "no")};
  EXPECT_EQ(best_record(history, 1e-4).objective, 5);
}

}  // namespace
}  // namespace pleuel::test::evaluation_cache_test
