#include <gtest/gtest.h>

#include "optimization/history.hpp"

namespace pleuel::test::best_record_test {
namespace {

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
}  // namespace pleuel::test::best_record_test
