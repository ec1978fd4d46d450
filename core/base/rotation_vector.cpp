#include "core/base/rotation_vector.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

/// Below this angle series are exact to round-off.
constexpr double small_angle = 1e-2;

/// Euler parameters (cos φ/2, sin(φ/2)/φ ψ).
Quaterniond euler_parameters(const Vector3d& psi) {
  const double half = 0.5 * psi.norm(), h2 = half * half;
  const double share = half < small_angle
                           ? 0.5 * (1.0 - h2 / 6.0 * (1.0 - h2 / 20.0 * (1.0 - h2 / 42.0)))
                           : 0.5 * std::sin(half) / half;
  Quaterniond parameters;
  parameters.w() = std::cos(half);
  parameters.vec() = share * psi;
  return parameters;
}

Vector3d vector_of(Quaterniond parameters) {
  if (parameters.w() < 0.0) parameters.coeffs() = -parameters.coeffs();
  const double sine = parameters.vec().norm();
  const double half = std::atan2(sine, parameters.w());
  // φ/sin(φ/2) → 2 + φ²/12
  const double share = sine < 1e-8 ? 2.0 : 2.0 * half / sine;
  return share * parameters.vec();
}

}  // namespace

Matrix3d rotation_of(const Vector3d& psi) {
  return euler_parameters(psi).toRotationMatrix();
}

Vector3d rotation_vector(const Matrix3d& rotation) {
  return vector_of(Quaterniond(rotation).normalized());
}

Vector3d compose(const Vector3d& psi, const Vector3d& delta) {
  return vector_of((euler_parameters(psi) * euler_parameters(delta)).normalized());
}

Matrix3d tangent_operator(const Vector3d& delta) {
  const RotationSeries<double> series(delta.squaredNorm());
  const Matrix3d d = skew(delta);
  return Matrix3d::Identity() - series.c2 * d + series.c3 * d * d;
}

Matrix3d inverse_tangent_operator(const Vector3d& delta) {
  return tangent_operator(delta).inverse();
}

}  // namespace pleuel
