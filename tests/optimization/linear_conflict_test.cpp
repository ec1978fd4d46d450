#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/linear_choice.hpp"

namespace pleuel::test::linear_conflict_test {
namespace {

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
}  // namespace pleuel::test::linear_conflict_test
