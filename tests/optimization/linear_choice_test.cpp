#include "optimization/linear_choice.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"

namespace pleuel::test::linear_choice_test {
namespace {

constexpr int variables = 4, sizes = 4, rows = 2;

LinearChoiceModel random_model(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  LinearChoiceModel model;
  model.objective = number(random);
  model.constraints = Eigen::VectorXd::Zero(rows);
  model.lower = Eigen::VectorXd::Constant(rows, -0.8);
  model.upper = Eigen::VectorXd::Constant(rows, 0.5);
  model.scales = Eigen::VectorXd::Constant(rows, 2.0);
  for (int i = 0; i < variables; ++i) {
    model.options.emplace_back();
    for (int k = 0; k < sizes; ++k) {
      Eigen::VectorXd change(rows);
      for (int j = 0; j < rows; ++j) change(j) = number(random);
      model.options.back().push_back({k, number(random), change});
    }
  }
  return model;
}

/// Every choice of the model that keeps its limits, by brute force: the lowest objective first.
std::vector<PredictedChoice> all_choices(const LinearChoiceModel& model, double allowed) {
  std::vector<PredictedChoice> all;
  for (int code = 0; code < sizes * sizes * sizes * sizes; ++code) {
    PredictedChoice one{{}, model.objective};
    Eigen::VectorXd values = model.constraints;
    for (int i = 0, rest = code; i < variables; ++i, rest /= sizes) {
      const LinearOption& option = model.options[i][rest % sizes];
      one.sizes.push_back(option.size);
      one.objective += option.objective;
      values += option.constraints;
    }
    const Eigen::VectorXd room = allowed * model.scales;
    if ((values.array() <= (model.upper + room).array()).all() &&
        (values.array() >= (model.lower - room).array()).all()) {
      all.push_back(std::move(one));
    }
  }
  std::sort(all.begin(), all.end(),
            [](const auto& one, const auto& other) { return one.objective < other.objective; });
  return all;
}

TEST(LinearChoice, FindsTheBestOfAllAsBruteForceDoes) {
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    for (const double allowed : {0.0, 0.1}) {
      const LinearChoiceModel model = random_model(seed);
      const std::vector<PredictedChoice> expected = all_choices(model, allowed);
      ASSERT_GE(expected.size(), 5u);
      const std::vector<PredictedChoice> found = best_choices(model, 5, allowed);
      ASSERT_EQ(found.size(), 5u);
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].sizes, expected[i].sizes) << seed << " " << i;
        EXPECT_NEAR(found[i].objective, expected[i].objective, 1e-12);
      }
    }
  }
}

TEST(LinearChoice, FindsNothingWhereNoChoiceKeepsTheLimits) {
  LinearChoiceModel model = random_model(1);
  model.lower.setConstant(100.0);
  model.upper.setConstant(101.0);
  EXPECT_TRUE(best_choices(model, 3, 0.0).empty());
}

TEST(LinearChoice, EndsAfterItsBudgetOfBranchings) {
  EXPECT_TRUE(best_choices(random_model(1), 3, 1e3, 3).empty());
}

}  // namespace
}  // namespace pleuel::test::linear_choice_test
