#include "core/mechanism/pivoted_factors.hpp"

#include <numeric>
#include <random>

#include "core/base/eager_matrices.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::pivoted_factors_test {
namespace {

std::vector<int> random_order(int size, std::mt19937& random) {
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

/// A quarter of the entries, and large ones where the pivots are.
Eigen::MatrixXd random_matrix(const std::vector<int>& rows, const std::vector<int>& columns,
                              std::mt19937& random) {
  const auto size = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(size, size);
  matrix = matrix.unaryExpr([&](double entry) { return random() % 4 == 0 ? entry : 0.0; });
  for (std::size_t k = 0; k < rows.size(); ++k)
    matrix(rows[k], columns[k]) = 10.0 + 0.5 * static_cast<double>(size);
  return matrix;
}

/// Sizes around those of blocks, long rows with gaps, and numbers of columns around those of groups.
TEST(PivotedFactors, SolveWhatTheMatrixMultiplies) {
  std::mt19937 random(3);
  for (const int size : {1, 2, 3, 4, 5, 7, 8, 9, 31, 64, 150}) {
    const std::vector<int> rows = random_order(size, random), columns = random_order(size, random);
    const Eigen::MatrixXd first = random_matrix(rows, columns, random);
    PivotedFactors factors(first.sparseView(), rows, columns);
    for (const double factor : {1.0, -0.5}) {  // the same places again
      const Eigen::MatrixXd matrix = factor * first;
      factors.factorize(matrix.sparseView());
      EXPECT_GT(factors.pivot_ratio(), 0.1);
      for (const int count : {1, 2, 4, 5, 8, 9, 17}) {
        const Eigen::MatrixXd expected = Eigen::MatrixXd::Random(size, count);
        Eigen::MatrixXd x = matrix * expected, y = matrix.transpose() * expected;
        factors.solve(x);
        factors.solve_transposed(y);
        EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-13) << size << ' ' << count;
        EXPECT_LE((y - expected).cwiseAbs().maxCoeff(), 1e-13) << size << ' ' << count;
      }
    }
  }
}

/// A diagonal with a full first row and column: eliminated first they fill everything, last
/// nothing.
TEST(PivotedFactors, HaveTheFillOfTheirOrder) {
  constexpr int size = 20;
  Eigen::MatrixXd arrow = 4.0 * Eigen::MatrixXd::Identity(size, size);
  arrow.row(0).setOnes();
  arrow.col(0).setOnes();
  arrow(0, 0) = size;
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  EXPECT_EQ(PivotedFactors(arrow.sparseView(), order, order).entries(), size * size);
  std::reverse(order.begin(), order.end());
  EXPECT_EQ(PivotedFactors(arrow.sparseView(), order, order).entries(), 3 * size - 2);
}

TEST(PivotedFactors, SeeWhatIsSingular) {
  const std::vector<int> order = {0, 1, 2};
  Eigen::Matrix3d matrix;
  matrix << 1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 3.0, 5.0, 6.0;  // regular, but with a pivot of zero
  PivotedFactors factors(matrix.sparseView(), order, order);
  factors.factorize(matrix.sparseView());
  EXPECT_FALSE(factors.pivot_ratio() > 0.0);
  matrix << 1.0, 2.0, 3.0, 2.0, 5.0, 7.0, 3.0, 7.0, 10.0;  // the third row is the sum of the others
  factors.factorize(matrix.sparseView());
  EXPECT_FALSE(factors.pivot_ratio() > 1e-15);
}

}  // namespace
}  // namespace pleuel::test::pivoted_factors_test
