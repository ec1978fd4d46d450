#include "core/base/eager_matrices.hpp"
#include "core/frame/marker_kinematics.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::elastic_rotation_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// From nothing to beyond all elasticity, and both sides of where the series end.
const double angles[] = {0.0, 1e-9, 1e-3, 0.12, 0.5, 0.999999, 1.000001, 2.0, 3.1};
const Vector3d axis(0.48, -0.6, 0.64), s(0.3, 0.8, -0.52), rate(-0.7, 0.4, 1.1),
    acceleration(0.9, 1.3, -0.4), moment(1.2, -0.3, 0.8);

TEST(ElasticRotation, TurnsDirectionsByTheAngleOfItsVectorAboutItsVector) {
  for (double angle : angles) {
    const ElasticRotation<double> rotation(angle * axis);
    const Vector3d expected = Eigen::AngleAxisd(angle, axis) * s;
    EXPECT_LE((rotation.turned(s) - expected).norm(), 1e-15) << angle;  // round-off
  }
}

/// Differences of the fourth order with steps of 1e-3: 1e-12 of fifth derivatives of a few units.
TEST(ElasticRotation, SpinsAsItsDirectionsMove) {
  for (double angle : angles) {
    const auto at = [&](double t) {
      return ElasticRotation<double>(angle * axis + t * rate + 0.5 * t * t * acceleration);
    };
    const Vector3d velocity =
        derivative_at_zero([&](double t) -> Vector3d { return at(t).turned(s); }, 1e-3);
    const Vector3d spin = at(0).spin(rate);
    EXPECT_LE((velocity - spin.cross(at(0).turned(s))).norm(), 1e-11) << angle;
    const Vector3d growth = derivative_at_zero(
        [&](double t) -> Vector3d { return at(t).spin(rate + t * acceleration); }, 1e-3);
    EXPECT_LE((growth - at(0).spin_rate(rate, acceleration)).norm(), 1e-11) << angle;
  }
}

TEST(ElasticRotation, GivesAMomentItsWorkOnTheTrueRotation) {
  for (double angle : angles) {
    const ElasticRotation<double> rotation(angle * axis);
    EXPECT_NEAR(rotation.generalized(moment).dot(rate), moment.dot(rotation.spin(rate)), 1e-15);
    EXPECT_LE((rotation.tangent() * rate - rotation.spin(rate)).norm(), 1e-15);
  }
}

TEST(ElasticRotation, HasTheCurvatureOfItsTurnedDirections) {
  for (double angle : angles) {
    const Vector3d psi = angle * axis;
    const ElasticRotation<double> rotation(psi);
    const Matrix3d found = rotation.curvature(rotation.tangent(), rotation.turned(s), moment);
    for (int j = 0; j < 3; ++j) {
      const Vector3d expected = derivative_at_zero(
          [&](double t) -> Vector3d {
            const ElasticRotation<double> moved(psi + t * Vector3d::Unit(j));
            return moved.generalized(moved.turned(s).cross(moment));
          },
          1e-3);
      EXPECT_LE((found.col(j) - expected).norm(), 1e-11) << angle;
    }
    EXPECT_LE((found - found.transpose()).norm(), 1e-15) << angle;
  }
}

/// In a plane angles add: nothing else turns, to round-off.
TEST(ElasticRotation, AboutOneAxisSpinsWithTheRateOfItsAngle) {
  for (double angle : angles) {
    const ElasticRotation<double> rotation(angle * axis);
    EXPECT_LE((rotation.spin(2.0 * axis) - 2.0 * axis).norm(), 1e-15);
    EXPECT_LE((rotation.spin_rate(2.0 * axis, -3.0 * axis) + 3.0 * axis).norm(), 1e-14);
    EXPECT_LE((rotation.generalized(2.0 * axis) - 2.0 * axis).norm(), 1e-15);
  }
}

/// Derivatives of the template against those by hand.
TEST(ElasticRotation, CarriesDualNumbers) {
  for (double angle : angles) {
    Vector3<Dual> psi;
    for (int i = 0; i < 3; ++i) {
      psi(i) = Dual(angle * axis(i), Dual::Derivatives::Constant(rate(i)));
    }
    const Vector3<Dual> turned = ElasticRotation<Dual>(psi).turned(s.cast<Dual>());
    const ElasticRotation<double> rotation(angle * axis);
    const Vector3d expected = rotation.spin(rate).cross(rotation.turned(s));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(derivative_of(turned(i)), expected(i), 1e-14) << angle;
  }
}

}  // namespace
}  // namespace pleuel::test::elastic_rotation_test
