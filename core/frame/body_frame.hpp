#pragma once

#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/base/dual.hpp"
#include "core/base/rotation_vector.hpp"

/// The floating frame of a body: which coordinates move it, and its kinematics.
namespace pleuel {

template <class Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
template <class Scalar>
using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;

template <class Scalar>
Matrix3<Scalar> skew(const Vector3<Scalar>& w) {
  Matrix3<Scalar> matrix;
  const Scalar zero(0);
  matrix << zero, -w(2), w(1), w(2), zero, -w(0), -w(1), w(0), zero;
  return matrix;
}

/// Coordinates of the rotation A (body to global axes).
enum class RotationCoordinates {
  none,            ///< a point mass has no orientation
  angle,           ///< A = R(axis, φ) A_ref: motion in a plane
  rotation_vector  ///< A = exp(ψ̃); rates are ω and α in body axes (rotation_vector.hpp)
};

/// Where the coordinates of a frame stand in q and what they mean: r = origin + basis · u.
/// The coordinates are (u, rotation), beginning at `offset`.
struct BodyFrame {
  int offset = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> basis = Eigen::Matrix3d::Identity();
  RotationCoordinates rotation = RotationCoordinates::none;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();          ///< of `angle`, global axes
  Eigen::Matrix3d reference = Eigen::Matrix3d::Identity();  ///< A_ref of `angle`

  int translations() const { return static_cast<int>(basis.cols()); }
  int rotations() const {
    switch (rotation) {
      case RotationCoordinates::none:
        return 0;
      case RotationCoordinates::angle:
        return 1;
      default:
        return 3;
    }
  }
  int size() const { return translations() + rotations(); }
};

/// A frame that does not move: the ground.
inline BodyFrame ground_frame() {
  BodyFrame frame;
  frame.basis.resize(3, 0);
  return frame;
}

/// Position, velocity and acceleration of a frame, with the derivatives that forces need.
template <class Scalar>
struct FrameMotion {
  Vector3<Scalar> r, r_dot, r_ddot;    ///< global axes
  Matrix3<Scalar> A, A_dot, A_ddot;    ///< exact time derivatives of A
  std::array<Matrix3<Scalar>, 3> A_p;  ///< ∂A/∂(rotation coordinate)
  Vector3<Scalar> omega, alpha;        ///< body axes; ω = G × (rates of the rotation coordinates)
  Eigen::Matrix<Scalar, 3, Eigen::Dynamic, 0, 3, 3> G;  ///< 3 × rotations
};

namespace frame_detail {

template <class Scalar>
void set_angle_motion(const BodyFrame& frame, const Scalar& angle, const Scalar& speed,
                      const Scalar& acceleration, FrameMotion<Scalar>& motion) {
  using std::cos;
  using std::sin;
  // Rodrigues: R = c I + s ñ + (1 − c) n nᵀ
  const Scalar c = cos(angle), s = sin(angle);
  const Matrix3<Scalar> n = skew<double>(frame.axis).template cast<Scalar>();
  const Matrix3<Scalar> nn = (frame.axis * frame.axis.transpose()).template cast<Scalar>();
  const Matrix3<Scalar> in_plane = Matrix3<double>::Identity().template cast<Scalar>() - nn;
  const Matrix3<Scalar> reference = frame.reference.template cast<Scalar>();
  motion.A = (nn + c * in_plane + s * n) * reference;
  motion.A_p[0] = (c * n - s * in_plane) * reference;
  motion.A_dot = speed * motion.A_p[0];
  motion.A_ddot =
      acceleration * motion.A_p[0] - (speed * speed) * ((c * in_plane + s * n) * reference);
  motion.G = (frame.reference.transpose() * frame.axis).template cast<Scalar>();
  motion.omega = speed * motion.G;
  motion.alpha = acceleration * motion.G;
}

/// Derivatives of A are those with respect to right perturbations: dual parts of ψ stand for δ.
template <class Scalar>
void set_spatial_motion(const Vector3<Scalar>& psi, const Vector3<Scalar>& omega,
                        const Vector3<Scalar>& alpha, FrameMotion<Scalar>& motion) {
  const Eigen::Vector3d fixed = value_matrix(psi);
  motion.A = rotation_of(fixed).template cast<Scalar>();
  if constexpr (!std::is_same_v<Scalar, double>) {
    const Vector3<Scalar> perturbation = psi - fixed.template cast<Scalar>();
    const Matrix3<Scalar> change = motion.A * skew<Scalar>(perturbation);
    motion.A += change;
  }
  const Matrix3<Scalar> spin = skew<Scalar>(omega);
  motion.A_dot = motion.A * spin;
  motion.A_ddot = motion.A * skew<Scalar>(alpha) + motion.A_dot * spin;
  for (int i = 0; i < 3; ++i) {
    const Vector3<Scalar> unit = Eigen::Vector3d::Unit(i).template cast<Scalar>();
    motion.A_p[static_cast<std::size_t>(i)] = motion.A * skew<Scalar>(unit);
  }
  motion.G = Matrix3<double>::Identity().template cast<Scalar>();
  motion.omega = omega;
  motion.alpha = alpha;
}

}  // namespace frame_detail

/// Kinematics of a frame from its own coordinates (size() entries) and their rates.
template <class Scalar, class Q, class V, class A>
FrameMotion<Scalar> frame_motion(const BodyFrame& frame, const Q& q, const V& v, const A& a) {
  FrameMotion<Scalar> motion;
  motion.r = frame.origin.template cast<Scalar>();
  motion.r_dot.setConstant(Scalar(0));
  motion.r_ddot.setConstant(Scalar(0));
  const int k = frame.translations();
  for (int i = 0; i < k; ++i) {
    const Vector3<Scalar> direction = frame.basis.col(i).template cast<Scalar>();
    motion.r += q(i) * direction;
    motion.r_dot += v(i) * direction;
    motion.r_ddot += a(i) * direction;
  }
  switch (frame.rotation) {
    case RotationCoordinates::none:
      motion.A = Matrix3<double>::Identity().template cast<Scalar>();
      motion.A_dot.setConstant(Scalar(0));
      motion.A_ddot.setConstant(Scalar(0));
      motion.omega.setConstant(Scalar(0));
      motion.alpha.setConstant(Scalar(0));
      motion.G.resize(3, 0);
      break;
    case RotationCoordinates::angle:
      frame_detail::set_angle_motion<Scalar>(frame, q(k), v(k), a(k), motion);
      break;
    case RotationCoordinates::rotation_vector:
      frame_detail::set_spatial_motion<Scalar>(q.template segment<3>(k), v.template segment<3>(k),
                                               a.template segment<3>(k), motion);
      break;
  }
  return motion;
}

}  // namespace pleuel
