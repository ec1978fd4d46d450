#include "core/base/band_modes.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::band_modes_test {
namespace {

Eigen::MatrixXd dense(const Band& band) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(band.cols(), band.cols());
  for (Eigen::Index j = 0; j < band.cols(); ++j) {
    for (Eigen::Index i = j; i < std::min(band.cols(), j + 6); ++i) {
      matrix(i, j) = matrix(j, i) = band(i - j, j);
    }
  }
  return matrix;
}

class AnyBands : public testing::TestWithParam<int> {
 protected:
  AnyBands() : a(6, GetParam()), b(6, GetParam()) {
    std::mt19937 random(static_cast<unsigned>(GetParam()));
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (double& entry : a.reshaped()) entry = number(random);
    for (double& entry : b.reshaped()) entry = number(random);
    b.row(0).setConstant(11.0);  // more than all beside it
  }
  Band a, b;
};

// 1e-12: round-off of both methods.

TEST_P(AnyBands, HaveTheLargestModeOfADenseSolver) {
  for (const double shift : {-3.0, 0.0, 3.0}) {  // few, half, most eigenvalues are positive
    a.row(0).array() += shift;
    const double expected = symmetric_eigenvalues(dense(a), dense(b)).maxCoeff();
    for (const double guess : {1e-6, 0.1, 1e4}) {
      LargestBandMode mode(b);
      const double value = mode.value(a, guess, 1e-9);
      EXPECT_NEAR(value, std::max(expected, 0.0), 1e-12) << shift << ", " << guess;
      if (value == 0.0) continue;
      const Eigen::VectorXd vector = mode.vectors().col(0);
      EXPECT_LT((dense(a) * vector - value * dense(b) * vector).norm(), 1e-12);
      EXPECT_NEAR(vector.dot(dense(b) * vector), 1.0, 1e-12);
    }
  }
}

TEST_P(AnyBands, HaveNoModeWhereAllEigenvaluesAreNegative) {
  a.row(0).array() -= 12.0;
  EXPECT_EQ(LargestBandMode(b).value(a, 1.0, 1e-9), 0.0);
}

/// Two equal blocks beside each other; their diagonal makes all eigenvalues positive.
TEST_P(AnyBands, HaveTwoVectorsOfATwofoldEigenvalue) {
  a.row(0).array() += 12.0;
  const Eigen::Index n = a.cols();
  Band twice_a = Band::Zero(6, 2 * n), twice_b = twice_a;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index d = 0; d < std::min<Eigen::Index>(6, n - j); ++d) {
      twice_a(d, j) = twice_a(d, n + j) = a(d, j);
      twice_b(d, j) = twice_b(d, n + j) = b(d, j);
    }
  }
  LargestBandMode mode(twice_b);
  const double value = mode.value(twice_a, 0.1, 1e-9);
  EXPECT_NEAR(value, symmetric_eigenvalues(dense(a), dense(b)).maxCoeff(), 1e-12);
  const Eigen::MatrixXd vectors = mode.vectors();
  ASSERT_EQ(vectors.cols(), 2);
  const Eigen::MatrixXd products = vectors.transpose() * dense(twice_b) * vectors;
  EXPECT_LT((products - Eigen::Matrix2d::Identity()).norm(), 1e-10);
  EXPECT_LT((dense(twice_a) * vectors - value * dense(twice_b) * vectors).norm(), 1e-9);
}

TEST_P(AnyBands, AreNotANumberWhereAnEntryIsNone) {
  a(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(LargestBandMode(b).value(a, 1.0, 1e-9)));
}

INSTANTIATE_TEST_SUITE_P(Sizes, AnyBands, testing::Values(1, 2, 5, 6, 7, 20, 61), named_by_value());

}  // namespace
}  // namespace pleuel::test::band_modes_test
