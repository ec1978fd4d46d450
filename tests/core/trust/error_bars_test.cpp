#include "core/trust/error_bars.hpp"

#include <cmath>

#include <gtest/gtest.h>

/// Estimates from runs with refined steps, on values whose error is known.
namespace pleuel {
namespace {

TEST(Extrapolation, FindsTheLimitOfASecondOrderSequence) {
  const double limit = 3.7, factor = 0.02;
  const auto at = [&](double h) { return limit + factor * h * h; };
  const Extrapolation found = extrapolate(at(1), at(2), at(4), 2, 0.0, 0.0);
  EXPECT_NEAR(at(1) + found.part.change, limit, 1e-14);
  EXPECT_NEAR(*found.order, 2.0, 1e-12);
  EXPECT_TRUE(found.part.is_resolved);
  EXPECT_GE(found.part.bound, std::abs(limit - at(1)));
  EXPECT_LE(found.part.bound, 2.0 * std::abs(limit - at(1)));
}

TEST(Extrapolation, FindsThatOfAFirstOrderSequence) {
  const auto at = [](double h) { return 1.0 - 0.01 * h; };
  const Extrapolation found = extrapolate(at(1), at(2), at(4), 1, 0.0, 0.0);
  EXPECT_NEAR(at(1) + found.part.change, 1.0, 1e-14);
  EXPECT_TRUE(found.part.is_resolved);
}

/// Terms of higher order make the estimate too small, 0.95 where 0.99 are missing, and 0.925 where
/// 0.985 are: the bound has reserve for that.
TEST(Extrapolation, CoversTermsOfHigherOrder) {
  for (const double share : {-0.01, -0.015}) {
    const auto at = [&](double h) { return 5.0 + 0.02 * h * h + share * 0.02 * std::pow(h, 4); };
    const Extrapolation found = extrapolate(at(1), at(2), at(4), 2, 0.0, 0.0);
    ASSERT_TRUE(found.part.is_resolved) << share;
    EXPECT_LT(std::abs(found.part.change), std::abs(5.0 - at(1))) << share;
    EXPECT_GE(found.part.bound, std::abs(5.0 - at(1))) << share;
  }
}

/// Differences of one sign that fall by 2 where 4 is promised, and such that change their sign.
TEST(Extrapolation, TakesTheLargerDifferenceWhereTheOrderIsAnother) {
  for (const double coarse : {1.03, 0.97, 1.2}) {
    const Extrapolation found = extrapolate(1.0, 1.01, coarse, 2, 0.0, 0.0);
    EXPECT_FALSE(found.part.is_resolved) << coarse;
    EXPECT_EQ(found.part.change, 0.0);
    EXPECT_DOUBLE_EQ(found.part.bound, std::max(0.01, std::abs(1.01 - coarse)));
  }
}

TEST(Extrapolation, NeedsNoOrderOfWhatIsSmall) {
  const Extrapolation found = extrapolate(1.0, 1.0001, 1.00005, 2, 0.0, 1e-3);
  EXPECT_TRUE(found.part.is_resolved);
  EXPECT_GE(found.part.bound, 1e-4);
  EXPECT_LE(found.part.bound, 2e-4);
}

/// Two peaks of the same height at other times: the values agree, the histories do not.
TEST(Extrapolation, DoesNotTrustPeaksThatAgreeByAccident) {
  const Extrapolation found = extrapolate(1.0, 1.0, 1.0, 2, 0.2, 1e-3);
  EXPECT_FALSE(found.part.is_resolved);
  EXPECT_DOUBLE_EQ(found.part.bound, 0.2);
}

/// A response of which nothing but its value is known.
class ErrorBarOfAValue : public testing::Test {
 protected:
  ErrorBarOfAValue() {
    analysis_.reductions.emplace_back().value = 10.0;
    analysis_.histories.emplace_back();
  }
  static NestedRun run(double value) {
    NestedRun run;
    run.values = Eigen::VectorXd::Constant(1, value);
    run.histories.emplace_back();
    return run;
  }
  static NestedRun failed() {
    NestedRun run;
    run.failure = "no";
    return run;
  }
  Analysis analysis_;
};

TEST_F(ErrorBarOfAValue, AddsUpItsParts) {
  const NestedRun twice = run(10.3), four = run(11.5), fewer = run(10.9), exact = run(11.52);
  JudgingRuns runs;
  runs.twice_step = &twice;
  runs.four_steps = &four;
  runs.elements = {&fewer, &twice};
  runs.newton = {&exact, &four};
  const ErrorBar bar = error_bar(analysis_, 0, runs, 2);
  EXPECT_NEAR(bar.step.change, -0.1, 1e-12);      // 10, 10.3, 11.5: order 2 towards 9.9
  EXPECT_NEAR(bar.elements.change, -0.2, 1e-12);  // half the elements have four times the error
  EXPECT_NEAR(bar.newton.change, 0.02, 1e-12);
  EXPECT_NEAR(bar.change(), -0.28, 1e-12);
  EXPECT_GE(bar.bound(), 0.32);
  EXPECT_TRUE(bar.is_resolved());
}

TEST_F(ErrorBarOfAValue, PrefersFinerRuns) {
  const NestedRun found = run(10.0), twice = run(10.4), half = run(9.9), more = run(9.7);
  JudgingRuns runs;
  runs.twice_step = &twice;
  runs.half_step = &half;
  runs.elements = {&more, &found};
  runs.element_factor = 2.0;
  const ErrorBar bar = error_bar(analysis_, 0, runs, 2);
  EXPECT_NEAR(bar.step.change, -0.1 - 0.1 / 3, 1e-12);
  EXPECT_GE(bar.step.bound, 0.1 + 0.1 / 3);
  EXPECT_NEAR(bar.elements.change, -0.4, 1e-12);
}

/// Half the step changes the value as much as twice the step: no order is seen.
TEST_F(ErrorBarOfAValue, TakesThreeTimesTheLastChangeWhereNothingFalls) {
  const NestedRun twice = run(10.1), half = run(9.9);
  JudgingRuns runs;
  runs.twice_step = &twice;
  runs.half_step = &half;
  const ErrorBar bar = error_bar(analysis_, 0, runs, 2);
  EXPECT_NEAR(bar.step.bound, 0.3, 1e-12);
  EXPECT_FALSE(bar.is_resolved());
}

/// Where half of the step shows no order, a quarter may: 10, 10.1, 10.125 go to 10.133.
TEST_F(ErrorBarOfAValue, AsksAQuarterOfTheStep) {
  const NestedRun twice = run(10.1), half = run(10.1), quarter = run(10.125);
  JudgingRuns runs;
  runs.twice_step = &twice;
  runs.half_step = &half;
  runs.quarter_step = &quarter;
  const ErrorBar bar = error_bar(analysis_, 0, runs, 2);
  EXPECT_TRUE(bar.is_resolved());
  EXPECT_NEAR(bar.step.change, 0.125 + 0.025 / 3, 1e-12);
  EXPECT_GE(bar.step.bound, 0.133);
}

TEST_F(ErrorBarOfAValue, IsNotResolvedWhereARunFailed) {
  const NestedRun broken = failed();
  JudgingRuns runs;
  runs.twice_step = &broken;
  EXPECT_FALSE(error_bar(analysis_, 0, runs, 2).is_resolved());
  const NestedRun twice = run(10.0), four = run(10.0);
  runs.twice_step = &twice;
  runs.four_steps = &four;
  EXPECT_TRUE(error_bar(analysis_, 0, runs, 2).is_resolved());
  runs.elements = {&broken, &twice};
  EXPECT_FALSE(error_bar(analysis_, 0, runs, 2).is_resolved());
}

}  // namespace
}  // namespace pleuel
