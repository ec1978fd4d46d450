#include "core/base/small_matrices.hpp"

#include <random>

#include "core/base/diameter.hpp"
#include "core/base/dual.hpp"
#include "core/base/eager_matrices.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::small_matrices_test {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// What an operator makes is a matrix, not an expression.
template <class Expected, class Result>
void expect_type(const Result&) {
  static_assert(std::is_same_v<Expected, Result>);
}

/// Eigen's operators, which take the base class, are the other computation.
template <class Matrix>
const Eigen::MatrixBase<Matrix>& as_base(const Matrix& matrix) {
  return matrix;
}

TEST(SmallMatrices, AreWhatEigenMakesOfTheSameSumsAndProducts) {
  const Matrix3d a = Matrix3d::Random(), b = Matrix3d::Random();
  const Vector3d u = Vector3d::Random(), w = Vector3d::Random();
  constexpr double round_off = 1e-15;  // of sums of three products below one
  expect_type<Vector3d>(u + w);
  expect_type<Vector3d>(a.transpose() * u);
  EXPECT_EQ(u + w, Vector3d(as_base(u) + as_base(w)));
  EXPECT_EQ(u - a.col(1), Vector3d(as_base(u) - as_base(a.col(1))));
  EXPECT_EQ(-a, Matrix3d(-as_base(a)));
  EXPECT_EQ(2.0 * a / 3.0, Matrix3d(2.0 * as_base(a)) / 3.0);
  EXPECT_LE((a * b - Matrix3d(as_base(a) * as_base(b))).norm(), round_off);
  EXPECT_LE((a.transpose() * u - Vector3d(as_base(a.transpose()) * as_base(u))).norm(), round_off);
  EXPECT_LE((u * w.transpose() - Matrix3d(as_base(u) * as_base(w.transpose()))).norm(), round_off);
  const double inner = u.transpose() * w;
  EXPECT_NEAR(inner, u.dot(w), round_off);
}

/// Of a size that is known to be at most three: nothing is allocated either.
TEST(SmallMatrices, MayHaveSizesUpToABound) {
  using Bounded = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>;
  const Matrix3d a = Matrix3d::Random();
  const Bounded two = Bounded::Random(3, 2), none(3, 0);
  expect_type<Bounded>(a * two);
  EXPECT_LE((a * two - Bounded(as_base(a) * as_base(two))).norm(), 1e-15);
  EXPECT_EQ((two.transpose() * two).rows(), 2);
  EXPECT_EQ(none * none.transpose(), Matrix3d(Matrix3d::Zero()));
}

/// d(A u)/dε = A' u + A u' of matrices of dual numbers, also beside plain ones.
TEST(SmallMatrices, OfDualNumbersObeyTheProductRule) {
  const Matrix3d a = Matrix3d::Random(), a_x = Matrix3d::Random();
  const Vector3d u = Vector3d::Random(), u_x = Vector3d::Random();
  Eigen::Matrix<Dual, 3, 3> dual_a;
  Eigen::Matrix<Dual, 3, 1> dual_u;
  for (int i = 0; i < 9; ++i) dual_a(i) = Dual(a(i), Dual::Derivatives(a_x(i)));
  for (int i = 0; i < 3; ++i) dual_u(i) = Dual(u(i), Dual::Derivatives(u_x(i)));
  constexpr double round_off = 4e-15;
  EXPECT_LE((derivative_matrix(dual_a * dual_u) - (a_x * u + a * u_x)).norm(), round_off);
  EXPECT_LE((derivative_matrix(dual_a * u) - a_x * u).norm(), round_off);
  EXPECT_LE((derivative_matrix(a * dual_u) - a * u_x).norm(), round_off);
  EXPECT_LE((derivative_matrix(2.0 * (dual_u - u)) - 2.0 * u_x).norm(), round_off);
}

class EagerMatrices : public testing::Test {
 protected:
  const MatrixXd a_ = MatrixXd::Random(7, 5), b_ = MatrixXd::Random(5, 4);
  const VectorXd x_ = VectorXd::Random(5), y_ = VectorXd::Random(7);
  static constexpr double round_off = 1e-14;  // of sums of seven products below one
};

TEST_F(EagerMatrices, AreWhatEigenMakesOfTheSameSums) {
  expect_type<VectorXd>(x_ + x_);
  expect_type<MatrixXd>(a_ - a_);
  EXPECT_EQ(x_ + b_.col(1), VectorXd(as_base(x_) + as_base(b_.col(1))));
  EXPECT_EQ(b_.topRows(4) - b_.topRows(4).transpose(),
            MatrixXd(as_base(b_.topRows(4)) - as_base(b_.topRows(4).transpose())));
  EXPECT_EQ(-(2 * x_) / 4, VectorXd(as_base(x_) / -2.0));
  EXPECT_EQ(x_.cwiseAbs() + x_, VectorXd(as_base(x_.cwiseAbs()) + as_base(x_)));
}

TEST_F(EagerMatrices, AreWhatEigenMakesOfTheSameProducts) {
  const auto expect_equal = [&](const MatrixXd& found, const MatrixXd& expected) {
    ASSERT_EQ(found.rows(), expected.rows());
    ASSERT_EQ(found.cols(), expected.cols());
    EXPECT_LE((found - expected).norm(), round_off);
  };
  expect_equal(a_ * b_, as_base(a_) * as_base(b_));
  expect_equal(a_ * x_, as_base(a_) * as_base(x_));
  expect_equal(a_.transpose() * y_, as_base(a_.transpose()) * as_base(y_));
  expect_equal(a_.leftCols(4) * b_.bottomRows(4), as_base(a_.leftCols(4)) * b_.bottomRows(4));
  expect_equal(y_ * x_.transpose(), as_base(y_) * as_base(x_.transpose()));
  expect_equal(y_.transpose() * a_, as_base(y_.transpose()) * as_base(a_));
  expect_equal(y_.asDiagonal() * a_, (as_base(a_).array().colwise() * y_.array()).matrix());
  expect_equal(a_ * x_.asDiagonal(),
               (as_base(a_).array().rowwise() * x_.transpose().array()).matrix());
  const double inner = x_.transpose() * x_;
  EXPECT_NEAR(inner, x_.squaredNorm(), round_off);
}

TEST_F(EagerMatrices, OfSparseOnesAreTheProductsOfDenseOnes) {
  const Eigen::SparseMatrix<double> columns = a_.sparseView();
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = a_.sparseView();
  EXPECT_LE((columns * x_ - a_ * x_).norm(), round_off);
  EXPECT_LE((rows * b_ - a_ * b_).norm(), round_off);
  EXPECT_LE((columns.transpose() * y_ - a_.transpose() * y_).norm(), round_off);
  EXPECT_LE((rows.transpose() * y_ - a_.transpose() * y_).norm(), round_off);
}

using Points = std::vector<Eigen::Vector3d>;

double largest_of_all_pairs(const Points& points) {
  double largest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      largest = std::max(largest, diameter({points[i], points[j]}));
    }
  }
  return largest;
}

/// To the last digit: pairs by the same function.
TEST(Diameter, IsTheLargestOfAllPairs) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 60; ++n) {
    for (const Eigen::Vector3d& shape :
         {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, 1e-3, 0), Eigen::Vector3d(0, 0, 0)}) {
      Points points, sphere;
      for (int i = 0; i < n; ++i) {
        const Eigen::Vector3d point(normal(random), normal(random), normal(random));
        points.push_back(Eigen::Vector3d(100, -3, 7) + shape.cwiseProduct(point));
        sphere.push_back(point.normalized());
      }
      EXPECT_EQ(diameter(points), largest_of_all_pairs(points)) << n;
      EXPECT_EQ(diameter(sphere), largest_of_all_pairs(sphere)) << n;
    }
  }
}

TEST(Diameter, OfTwoPointsIsTheirDistance) {
  const Eigen::Vector3d a(100, -3, 7), b(0.1, 1.7, 1e-3);
  EXPECT_DOUBLE_EQ(diameter({a, b}), (a - b).norm());
}

TEST(Diameter, OfAChainIsItsLength) {
  Points points;
  for (int i = 0; i <= 5000; ++i) points.emplace_back(0.5 * i, 0.0, i % 2);
  EXPECT_DOUBLE_EQ(diameter(points), 2500.0);
}

}  // namespace
}  // namespace pleuel::test::small_matrices_test
