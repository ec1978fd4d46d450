#include "core/base/dual.hpp"

#include <random>

#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"
#include "core/base/rotation_vector.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::dual_test {
namespace {

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

using Eigen::Matrix3d;
using Eigen::Vector3d;

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
}  // namespace pleuel::test::dual_test
