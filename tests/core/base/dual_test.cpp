#include "core/base/dual.hpp"

#include <random>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"

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

}  // namespace
}  // namespace pleuel::test::dual_test
