#include "core/trust/error_bars.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/response/history_reduction.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/checks.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::error_bars_test {
namespace {

// Estimates from runs with refined steps, on values whose error is known.

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

/// Differences of one sign that fall by 1.5 where 4 is promised, and such that change their sign.
/// The last one may be small by accident: a quarter of the one before counts, too.
TEST(Extrapolation, TakesTwiceTheLargerDifferenceWhereTheOrderIsAnother) {
  const auto bound_of = [](double coarse) {
    const Extrapolation found = extrapolate(1.0, 1.01, coarse, 2, 0.0, 0.0);
    EXPECT_FALSE(found.has_promised_order) << coarse;
    EXPECT_FALSE(found.part.is_resolved) << coarse;
    EXPECT_EQ(found.part.change, 0.0);
    return found.part.bound;
  };
  EXPECT_NEAR(bound_of(1.025), 2 * 0.01, 1e-12);
  EXPECT_NEAR(bound_of(0.99), 2 * 0.01, 1e-12);
  EXPECT_NEAR(bound_of(0.81), 2 * 0.2 / 4, 1e-12);
}

/// Of 0.81, 0.99, 1 the difference falls by 18: nothing but 0.01 / 3 would be left by order 2. Of
/// 0.969, 0.99, 1 it falls by 2.1: as much as the last difference is left by order 1.
TEST(Extrapolation, TakesTheLargerDifferenceOnceWhereItFallsByTwoAtLeast) {
  const Extrapolation fast = extrapolate(1.0, 0.99, 0.81, 2, 0.0, 0.1);
  EXPECT_NEAR(fast.part.bound, 0.18 / 4, 1e-12);
  EXPECT_TRUE(fast.part.is_resolved);
  const Extrapolation slow = extrapolate(1.0, 0.99, 0.969, 2, 0.0, 0.1);
  EXPECT_NEAR(slow.part.bound, 0.01, 1e-12);
}

/// v(h) = h² + r hᵖ for all r: also where both cancel in the last difference, or in the error.
TEST(Extrapolation, CoversErrorsOfTwoTermsWhateverTheirRatio) {
  for (const double power : {3.0, 4.0, 5.0}) {
    for (int i = -1000; i <= 1000; ++i) {
      const double ratio = std::sinh(0.01 * i);
      const auto at = [&](double h) { return h * h + ratio * std::pow(h, power); };
      const Extrapolation found = extrapolate(at(1), at(2), at(4), 2, 0.0, 0.0);
      ASSERT_LE(std::abs(at(1)), found.part.bound) << ratio << " h^" << power;
    }
  }
}

TEST(Extrapolation, NeedsNoOrderOfWhatIsSmall) {
  const Extrapolation found = extrapolate(1.0, 1.0001, 1.00005, 2, 0.0, 1e-3);
  EXPECT_TRUE(found.part.is_resolved);
  EXPECT_TRUE(found.part.is_resolved);
  EXPECT_NEAR(found.part.bound, 2e-4, 1e-15);
}

/// Two peaks of the same height at other times: the values agree, the histories do not.
TEST(Extrapolation, DoesNotTrustPeaksThatAgreeByAccident) {
  const Extrapolation found = extrapolate(1.0, 1.0, 1.0, 2, 0.2, 1e-3);
  EXPECT_FALSE(found.part.is_resolved);
  EXPECT_GE(found.part.bound, 0.2);
}

/// A response with a history of one instant.
class ErrorBarOfAValue : public testing::Test {
 protected:
  ErrorBarOfAValue() {
    analysis_.responses.emplace_back().name = "value";
    analysis_.reductions.emplace_back().value = 10.0;
    analysis_.histories.add(
        std::make_shared<const Eigen::MatrixXd>(Eigen::MatrixXd::Constant(1, 1, 10.0)));
  }
  static RefinedRun run(double value) {
    RefinedRun run;
    run.values = Eigen::VectorXd::Constant(1, value);
    run.histories.add(std::make_shared<const Eigen::MatrixXd>());
    return run;
  }
  static RefinedRun failed() {
    RefinedRun run;
    run.failure = "no";
    return run;
  }
  Analysis analysis_;
};

TEST_F(ErrorBarOfAValue, AddsUpItsParts) {
  const RefinedRun twice = run(10.3), four = run(11.5), fewer = run(10.9), exact = run(11.52);
  JudgingRuns runs;
  runs.twice_step = &twice;
  runs.four_steps = &four;
  runs.fewer_elements = {&fewer, &twice};
  runs.newton = {&exact, &four};
  const ErrorBar bar = error_bar(evidence_of(analysis_, 0, runs, 2));
  EXPECT_NEAR(bar.step.change, -0.1, 1e-12);      // 10, 10.3, 11.5: order 2 towards 9.9
  EXPECT_NEAR(bar.elements.change, -0.2, 1e-12);  // half the elements have four times the error
  EXPECT_NEAR(bar.newton.change, 0.02, 1e-12);
  EXPECT_NEAR(bar.change(), -0.28, 1e-12);
  EXPECT_GE(bar.bound(), 0.32);
  EXPECT_NEAR(bar.elements.bound, 0.6, 1e-12);
  EXPECT_TRUE(bar.is_resolved());
}

TEST_F(ErrorBarOfAValue, PrefersFinerRuns) {
  const RefinedRun found = run(10.0), twice = run(10.4), half = run(9.9), more = run(9.7);
  JudgingRuns runs;
  runs.half_step = &half;
  runs.twice_step = &twice;
  runs.more_elements = {&more, &found};
  const ErrorBar bar = error_bar(evidence_of(analysis_, 0, runs, 2));
  EXPECT_NEAR(bar.step.change, -0.1 - 0.1 / 3, 1e-12);
  EXPECT_GE(bar.step.bound, 0.1 + 0.1 / 3);
  EXPECT_NEAR(bar.elements.change, -0.4, 1e-12);
}

/// Half the step changes the value as much as twice the step: no order is seen. The change itself,
/// and twice as much that finer steps may add.
TEST_F(ErrorBarOfAValue, TakesThreeTimesTheLastChangeWhereNothingFalls) {
  const RefinedRun twice = run(12.0), half = run(8.0), near = run(9.9), far = run(10.1);
  JudgingRuns runs;
  runs.half_step = &half;
  runs.twice_step = &twice;
  const ErrorBar coarse = error_bar(evidence_of(analysis_, 0, runs, 2));
  EXPECT_NEAR(coarse.step.bound, 6.0, 1e-12);
  EXPECT_FALSE(coarse.is_resolved());
  runs.twice_step = &far;
  runs.half_step = &near;
  const ErrorBar fine = error_bar(evidence_of(analysis_, 0, runs, 2));
  EXPECT_NEAR(fine.step.bound, 0.3, 1e-12);
  EXPECT_TRUE(fine.is_resolved());  // 3 % need no order
}

/// Where half of the step shows no order, a quarter may: 10, 10.1, 10.125 go to 10.133.
TEST_F(ErrorBarOfAValue, AsksAQuarterOfTheStep) {
  const RefinedRun twice = run(10.1), half = run(10.1), quarter = run(10.125);
  JudgingRuns runs;
  runs.quarter_step = &quarter;
  runs.half_step = &half;
  runs.twice_step = &twice;
  const ErrorBar bar = error_bar(evidence_of(analysis_, 0, runs, 2));
  EXPECT_TRUE(bar.is_resolved());
  EXPECT_NEAR(bar.step.change, 0.125 + 0.025 / 3, 1e-12);
  EXPECT_GE(bar.step.bound, 0.133);
}

/// Of order two, more elements leave a third of what they changed; fewer may leave all of it. Where
/// more elements agree by accident, to the same side or almost, fewer have a say.
TEST_F(ErrorBarOfAValue, PrefersMoreElementsToFewer) {
  const RefinedRun twice = run(10.0), four = run(10.0), more = run(10.03), fewer = run(9.8),
                   far = run(8.6), other_side = run(10.6);
  JudgingRuns runs;
  runs.twice_step = &twice;
  runs.four_steps = &four;
  runs.fewer_elements = {&fewer, &twice};
  EXPECT_NEAR(error_bar(evidence_of(analysis_, 0, runs, 2)).elements.bound, 0.2, 1e-12);
  runs.more_elements = {&more, &twice};
  EXPECT_NEAR(error_bar(evidence_of(analysis_, 0, runs, 2)).elements.change, 0.04, 1e-12);
  EXPECT_NEAR(error_bar(evidence_of(analysis_, 0, runs, 2)).elements.bound, 0.06, 1e-12);
  runs.fewer_elements = {&other_side, &twice};
  EXPECT_NEAR(error_bar(evidence_of(analysis_, 0, runs, 2)).elements.bound, 0.15, 1e-12);
  runs.fewer_elements = {&far, &twice};
  EXPECT_NEAR(error_bar(evidence_of(analysis_, 0, runs, 2)).elements.bound, 0.14, 1e-12);
}

/// 10, 10.3, 11.5 and 20, 19.7, 18.5: as a sum nothing changes, each for itself does.
TEST_F(ErrorBarOfAValue, OfASumKnowsWhatCancels) {
  Evidence one, other;
  one.value = 10.0;
  one.twice_step = 10.3;
  one.four_steps = 11.5;
  one.fewer_elements = 0.2;
  other.value = 20.0;
  other.twice_step = 19.7;
  other.four_steps = 18.5;
  other.fewer_elements = 0.1;
  one.magnitude = other.magnitude = 20.0;
  EXPECT_GT(error_bar(one).step.bound, 0.1);
  one.add(other, 1.0);
  EXPECT_NEAR(error_bar(one).step.bound, 0.0, 1e-12);
  EXPECT_NEAR(error_bar(one).elements.bound, 0.3, 1e-12);
  one.add(other, -2.0);  // 10 − 20, 10.3 − 19.7 …
  EXPECT_NEAR(error_bar(one).step.change, -0.2, 1e-12);
}

TEST_F(ErrorBarOfAValue, IsNotResolvedWhereARunFailed) {
  const RefinedRun broken = failed();
  JudgingRuns runs;
  runs.twice_step = &broken;
  EXPECT_FALSE(error_bar(evidence_of(analysis_, 0, runs, 2)).is_resolved());
  const RefinedRun twice = run(10.0), four = run(10.0);
  runs.twice_step = &twice;
  runs.four_steps = &four;
  EXPECT_TRUE(error_bar(evidence_of(analysis_, 0, runs, 2)).is_resolved());
  runs.fewer_elements = {&broken, &twice};
  EXPECT_FALSE(error_bar(evidence_of(analysis_, 0, runs, 2)).is_resolved());
}

/// As of a mass and the limits that decide on it: the constant takes no evidence away.
TEST_F(ErrorBarOfAValue, OfASumWithAConstantIsThatOfTheRest) {
  const RefinedRun four = run(11.5), twice = run(10.3), half = run(9.93), quarter = run(9.91);
  JudgingRuns runs;
  runs.quarter_step = &quarter;
  runs.half_step = &half;
  runs.twice_step = &twice;
  runs.four_steps = &four;
  const Evidence varying = evidence_of(analysis_, 0, runs, 2);
  analysis_.histories.set(0, {});
  Evidence sum = evidence_of(analysis_, 0, runs, 2);
  sum.add(varying, 2.0);
  const ErrorBar bar = error_bar(sum), of_rest = error_bar(varying);
  EXPECT_NEAR(bar.step.change, 2.0 * of_rest.step.change, 1e-12);
  EXPECT_NEAR(bar.step.bound, 2.0 * of_rest.step.bound, 1e-12);
}

TEST_F(ErrorBarOfAValue, IsExactOfAConstantWhereStepsFailed) {
  analysis_.histories.set(0, {});
  const RefinedRun broken = failed();
  JudgingRuns runs;
  runs.half_step = runs.twice_step = runs.four_steps = &broken;
  const ErrorBar bar = error_bar(evidence_of(analysis_, 0, runs, 2));
  EXPECT_TRUE(bar.is_resolved());
  EXPECT_EQ(bar.bound(), 0.0);
}

// Bodies from files, at other designs than the file's.

/// A rigid-looking body whose file knows its mass at h = 30 mm and how it changes; only the finding's
/// own decision is looked at.
TEST(Extrapolation, IsADoubtWhereTheDesignHasLeftThatOfTheFile) {
  ProblemFile problem = read_scene(crank_rocker(driven, closed));
  const StartRun start(problem);
  auto file = std::make_shared<InvariantsFile>();
  file->design.push_back({"h", 0.03, "m", file->constants});
  file->design.back().derivative->mass = 2.0;
  ImportedBody imported;
  imported.source = "rod.json";
  imported.file = file;
  imported.variables = {{Number::bound(0), quantities::length, 0}};
  problem.variables = {{"h", 0.03, 0.004, 0.06, "m"}};
  problem.scene.bodies.push_back({"imported", imported});
  const auto findings_at = [&](double height) {
    Eigen::VectorXd x(1);
    x << height;
    return check_extrapolation(TrustedRun{problem, x, *start.analysis, start.monitors});
  };
  EXPECT_THAT(findings_at(0.02), IsEmpty()) << "not continued";
  std::get<ImportedBody>(problem.scene.bodies.back().shape).is_linear = true;
  EXPECT_THAT(findings_at(0.03), IsEmpty());
  EXPECT_THAT(findings_at(0.03 * (1 + 0.9e-4)), IsEmpty());
  EXPECT_THAT(findings_at(0.03 * (1 - 0.9e-4)), IsEmpty());
  EXPECT_THAT(findings_at(0.03 * (1 + 1.1e-4)), SizeIs(1));
  EXPECT_THAT(findings_at(0.03 * (1 - 1.1e-4)), SizeIs(1));
  EXPECT_THAT(findings_at(0.03 * (1 + 1e-9)), IsEmpty());
  ASSERT_THAT(findings_at(0.0303), SizeIs(1));
  EXPECT_TRUE(findings_at(0.0303)[0].is_serious);
  EXPECT_THAT(findings_at(0.0303)[0].text, HasSubstr("h = 0.0303 instead of 0.03 m"));
  EXPECT_THAT(findings_at(0.0303)[0].text, HasSubstr("rod.json"));
}

// Bands around histories against runs at an eighth of the step with four times the elements.

/// Errors of vibrations pass through zero; instants.
constexpr Eigen::Index nearby = 5;

struct Coverage {
  double covered = 0.0;  ///< share of instants
  /// Median of the band over the largest error nearby, of errors above a thousandth of the history.
  double ratio = 0.0;
};

/// Of all histories of a problem.
Coverage coverage(const std::string& name, const std::vector<std::string>& overrides) {
  const ProblemFile problem =
      read_problem(source_folder() + "/problems/" + name + ".json", overrides).complete();
  const StartRun start(problem);
  const std::vector<Eigen::VectorXd> bands = judge_run(start.run()).bands;
  const RefinedRun exact = make_refined_run(problem, start.x, {0.125, 4.0});
  EXPECT_EQ(exact.time.size(), 8 * (start.analysis->trajectory.time.size() - 1) + 1);
  double covered = 0.0, instants = 0.0;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    if (start.analysis->histories[i].size() == 0) continue;
    const Response& response = start.analysis->responses[i];
    const Eigen::VectorXd here = shown_history(response, start.analysis->histories[i]);
    const Eigen::VectorXd there = shown_history(response, exact.histories[i]);
    const double largest = here.cwiseAbs().maxCoeff();
    EXPECT_EQ(bands[i].size(), here.size()) << response.name;
    Eigen::VectorXd error(here.size());
    for (Eigen::Index k = 0; k < error.size(); ++k) error(k) = std::abs(there(8 * k) - here(k));
    for (Eigen::Index k = 0; k < error.size(); ++k) {
      instants += 1.0;
      if (error(k) <= bands[i](k) + 1e-9 * largest) covered += 1.0;
      const Eigen::Index first = std::max<Eigen::Index>(k - nearby, 0);
      const Eigen::Index last = std::min(k + nearby, error.size() - 1);
      const double around = error.segment(first, last - first + 1).maxCoeff();
      if (around > 1e-3 * largest) ratios.push_back(bands[i](k) / around);
    }
  }
  if (ratios.empty()) return {covered / instants, 1.0};
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return {covered / instants, *middle};
}

TEST(ErrorBands, HoldTheTrueHistories) {
  const auto check = [](const std::string& name, const std::vector<std::string>& overrides) {
    const Coverage found = coverage(name, overrides);
    EXPECT_GE(found.covered, 0.95) << name << overrides.front();
    EXPECT_LE(found.ratio, 5.0) << name << overrides.front();
    testing::Test::RecordProperty(name, std::to_string(found.covered));
  };
  check("slider_crank_round", {"/simulation/step=0.1 ms"});
  check("slider_crank_round", {"/simulation/step=0.4 ms"});
  check("four_bar", {"/simulation/step=0.5 ms"});
  check("robot_arm", {"/simulation/step=1 ms"});
  check("spatial_slider_crank", {"/simulation/step=0.4 ms", "/scene/bodies/rod/elements=2"});
}

TEST(ErrorBands, AreNotMadeWhereNothingIsChecked) {
  const ProblemFile problem =
      read_problem(source_folder() + "/problems/robot_arm.json",
                   {"/simulation/step=4 ms", "/simulation/resolution_check=false"})
          .complete();
  const StartRun start(problem);
  EXPECT_THAT(judge_run(start.run()).bands, IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::error_bars_test
