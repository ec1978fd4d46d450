#include "core/base/small_matrices.hpp"

#include <random>

#include <Eigen/Geometry>

#include "core/base/diameter.hpp"
#include "core/base/dual.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/rotation_vector.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/differences.hpp"
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

using Two = DualOf<2>;
using Complex = std::complex<double>;

/// The derivatives of f(a, b), a and b the two directions, against the complex step, which is exact
/// to round-off (Squire & Trapp 1998).
template <class Function>
void expect_exact(Function f) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> number(0.3, 2.0);
  const double step = 1e-30;
  for (int repeat = 0; repeat < 20; ++repeat) {
    const double a = number(generator), b = number(generator);
    const Two y = f(Two(a, {1.0, 0.0}), Two(b, {0.0, 1.0}));
    const Complex by_a = f(Complex(a, step), Complex(b)), by_b = f(Complex(a), Complex(b, step));
    const double bound = 1e-14 * (1.0 + y.derivatives().norm());  // some tens of roundings
    EXPECT_NEAR(y.value(), by_a.real(), 1e-14 * (1.0 + std::abs(y.value())));
    EXPECT_NEAR(y.derivatives()(0), by_a.imag() / step, bound);
    EXPECT_NEAR(y.derivatives()(1), by_b.imag() / step, bound);
  }
}

TEST(DualNumbers, SumsAndProductsAreExact) {
  expect_exact([](auto a, auto b) { return a + b - a * b; });
  expect_exact([](auto a, auto b) { return -a / b; });
  expect_exact([](auto a, auto b) { return (a += b, a *= b, a -= b * b, a /= b); });
}

TEST(DualNumbers, OperationsWithPlainNumbersAreExact) {
  expect_exact([](auto a, auto b) { return 2.0 * a + b * 3.0 - a / 4.0; });
  expect_exact([](auto a, auto b) { return 5.0 / a - (1.0 - b) + (a - 2.0) * (3.0 + b + 1.0); });
}

TEST(DualNumbers, FunctionsAreExact) {
  expect_exact([](auto a, auto b) { return sqrt(a * b) + exp(-a); });
  expect_exact([](auto a, auto b) { return sin(a) * cos(b) + tanh(a * b); });
}

/// tan of the angle is y/x: by the complex step of the quotient.
TEST(DualNumbers, AngleIsExactInAllQuadrants) {
  for (const double y : {-1.3, 0.4}) {
    for (const double x : {-0.7, 2.1}) {
      const Two angle = atan2(Two(y, {1.0, 0.0}), Two(x, {0.0, 1.0}));
      EXPECT_EQ(angle.value(), std::atan2(y, x));
      // d tan(angle) = (1 + tan²) d(angle)
      const double slope = 1.0 + (y / x) * (y / x);
      EXPECT_NEAR(slope * angle.derivatives()(0), 1.0 / x, 1e-14 * slope);
      EXPECT_NEAR(slope * angle.derivatives()(1), -y / (x * x), 1e-14 * slope);
    }
  }
}

TEST(DualNumbers, MagnitudeAndOrderAreThoseOfTheValue) {
  const Two a(-2.0, {3.0, -1.0});
  EXPECT_EQ(abs(a).value(), 2.0);
  EXPECT_EQ(abs(a).derivatives(), Eigen::Vector2d(-3.0, 1.0));
  EXPECT_EQ(abs(-a).derivatives(), Eigen::Vector2d(-3.0, 1.0));
  EXPECT_LT(a, Two(-1.0));
  EXPECT_GT(a, -3.0);
}

TEST(DualNumbers, ServeAsScalarsOfEigen) {
  const Eigen::Matrix2d A = (Eigen::Matrix2d() << 1.0, 2.0, -3.0, 0.5).finished();
  const Eigen::Vector2d start(0.7, -1.1);
  const Eigen::Matrix<Two, 2, 1> x(Two(start(0), {1.0, 0.0}), Two(start(1), {0.0, 1.0}));
  const Two form = x.dot(A * x);  // gradient (A + Aᵀ) x
  EXPECT_NEAR(form.value(), start.dot(A * start), 1e-14);
  EXPECT_LE((form.derivatives() - (A + A.transpose()) * start).norm(), 1e-14);
}

Matrix3d tilde(const Vector3d& w) {
  Matrix3d matrix;
  matrix << 0, -w(2), w(1), w(2), 0, -w(0), -w(1), w(0), 0;
  return matrix;
}

/// From nearly nothing to half a turn.
const double angles[] = {0.0, 1e-12, 1e-7, 1e-3, 9.99e-3, 1.01e-2, 0.0999, 0.101, 1.0, 2.5, 3.1415};
const Vector3d axis(0.48, -0.6, 0.64);

TEST(RotationVector, IsTheLogarithmOfItsRotation) {
  for (double angle : angles) {
    const Vector3d psi = angle * axis;
    EXPECT_LE((rotation_of(psi) - exponential(tilde(psi))).norm(), 1e-14) << angle;
    EXPECT_LE((rotation_vector(rotation_of(psi)) - psi).norm(), 1e-14) << angle;
  }
}

TEST(RotationVector, ComposesLikeItsRotation) {
  const Vector3d delta(0.3, 0.8, -0.2);
  for (double angle : angles) {
    const Vector3d psi = angle * axis;
    EXPECT_LE((rotation_of(compose(psi, delta)) - rotation_of(psi) * rotation_of(delta)).norm(),
              1e-15 * 10)
        << angle;
  }
}

TEST(RotationVector, AddsAnglesAboutOneAxisUpToWholeTurns) {
  Vector3d psi = Vector3d::Zero();
  for (int i = 0; i < 1000; ++i) psi = compose(psi, 0.1 * axis);
  const double angle = std::remainder(100.0, 2 * std::numbers::pi);
  EXPECT_LE((psi - angle * axis).norm(), 1e-12);
}

/// exp((δ + ε)~) = exp(δ̃) exp((T ε)~) + O(ε²), by differences.
TEST(TangentOperator, IsTheDerivativeOfTheExponential) {
  for (double angle : angles) {
    const Vector3d delta = angle * axis;
    Matrix3d expected;
    for (int i = 0; i < 3; ++i) {
      expected.col(i) = derivative_at_zero(
          [&](double s) -> Vector3d {
            const Vector3d moved = delta + s * Vector3d::Unit(i);
            return rotation_vector(rotation_of(delta).transpose() * rotation_of(moved));
          },
          1e-2);
    }
    // The differences' fourth-order error at this step.
    EXPECT_LE((tangent_operator(delta) - expected).norm(), 1e-9) << angle;
    EXPECT_LE(
        (tangent_operator(delta) * inverse_tangent_operator(delta) - Matrix3d::Identity()).norm(),
        1e-14)
        << angle;
  }
}

}  // namespace
}  // namespace pleuel::test::small_matrices_test
