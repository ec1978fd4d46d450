#include "core/base/rotation_vector.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/differences.hpp"

namespace pleuel::test::rotation_vector_test {
namespace {

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
}  // namespace pleuel::test::rotation_vector_test
