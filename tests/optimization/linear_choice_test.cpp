#include "optimization/linear_choice.hpp"

#include <limits>
#include <random>

#include "core/base/eager_matrices.hpp"
#include "tests/support/test.hpp"

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

using Indexes = std::vector<std::size_t>;
constexpr double none = std::numeric_limits<double>::infinity();

/// 0 ≤ x, y ≤ 1 with other limits.
Indexes conflict_of(const Eigen::MatrixXd& rows, const Eigen::VectorXd& lower,
                    const Eigen::VectorXd& upper) {
  return linear_conflict({rows, lower, upper}, Eigen::VectorXd::Zero(rows.cols()),
                         Eigen::VectorXd::Ones(rows.cols()));
}

TEST(LinearConflict, NamesThePairThatExcludesEachOther) {
  Eigen::MatrixXd rows(3, 2);
  rows << -1, 1, 1, 1, 1, -1;
  // y − x ≥ 0.5 and x − y ≥ 0, beside a harmless one.
  EXPECT_EQ(conflict_of(rows, Eigen::Vector3d(0.5, -none, 0.0), Eigen::Vector3d(none, 2.0, none)),
            (Indexes{0, 2}));
  EXPECT_EQ(conflict_of(rows, Eigen::Vector3d(0.5, -none, -0.5), Eigen::Vector3d(none, 2.0, none)),
            Indexes{});
}

TEST(LinearConflict, NamesALimitThatTheBoundsExclude) {
  Eigen::MatrixXd rows(1, 2);
  rows << 1, 1;
  const auto one = [](double x) { return Eigen::VectorXd::Constant(1, x).eval(); };
  EXPECT_EQ(conflict_of(rows, one(2.0), one(none)), Indexes{});
  EXPECT_EQ(conflict_of(rows, one(2.0 + 1e-6), one(none)), Indexes{0});
}

/// Limits that some point keeps are none; those of which one excludes all points of the others by a
/// margin are, whatever they are: b of a positive combination of the rows, lowered.
TEST(LinearConflict, IsThatOfRandomLimits) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int sample = 0; sample < 200; ++sample) {
    const Eigen::Index variables = 1 + sample % 5, limits = 2 + sample % 6;
    const Eigen::MatrixXd rows =
        Eigen::MatrixXd::NullaryExpr(limits, variables, [&]() { return uniform(engine); });
    const Eigen::VectorXd inside =
        Eigen::VectorXd::NullaryExpr(variables, [&]() { return 0.5 + 0.5 * uniform(engine); });
    const Eigen::VectorXd free = Eigen::VectorXd::Constant(limits, none);
    const Eigen::VectorXd upper = rows * inside;
    EXPECT_EQ(conflict_of(rows, -free, upper), Indexes{}) << sample;
    // The last row as the negative of the sum of all others: their sum cannot be above their limits.
    Eigen::MatrixXd closed = rows;
    closed.row(limits - 1) = -rows.topRows(limits - 1).colwise().sum();
    Eigen::VectorXd closed_upper = upper;
    closed_upper(limits - 1) = -upper.head(limits - 1).sum() - 1e-3;
    EXPECT_FALSE(conflict_of(closed, -free, closed_upper).empty()) << sample;
    // Limits that touch leave a point; the round-off with which they do is no conflict.
    for (const double gap : {0.0, 1e-16, 1e-13, 1e-11}) {
      closed_upper(limits - 1) = -upper.head(limits - 1).sum() - gap;
      EXPECT_EQ(conflict_of(closed, -free, closed_upper), Indexes{}) << sample << " " << gap;
    }
  }
}

}  // namespace
}  // namespace pleuel::test::linear_choice_test
