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

/// Position and orientation of a body.
template <class Scalar>
struct Pose {
  Vector3<Scalar> origin;
  Matrix3<Scalar> rotation;  ///< body to global axes
};

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

/// Rodrigues with n = axis, R A_ref = n nᵀA_ref + c P + s ñ A_ref and P = (I − n nᵀ) A_ref
template <class Scalar>
void set_angle_motion(const BodyFrame& frame, const Scalar& angle, const Scalar& speed,
                      const Scalar& acceleration, FrameMotion<Scalar>& motion) {
  using std::cos;
  using std::sin;
  const Scalar c = cos(angle), s = sin(angle), squared = speed * speed;
  const Eigen::Vector3d normal = frame.reference.transpose() * frame.axis;
  const Eigen::Matrix3d across = skew<double>(frame.axis) * frame.reference;
  const Eigen::Matrix3d along = frame.axis * normal.transpose();
  const Eigen::Matrix3d in_plane = frame.reference - along;
  for (int k = 0; k < 9; ++k) {
    const Scalar turned = c * in_plane(k) + s * across(k);
    const Scalar slope = c * across(k) - s * in_plane(k);
    motion.A(k) = turned + along(k);
    motion.A_p[0](k) = slope;
    motion.A_dot(k) = speed * slope;
    motion.A_ddot(k) = acceleration * slope - squared * turned;
  }
  motion.G.resize(3, 1);
  for (int k = 0; k < 3; ++k) {
    motion.G(k) = Scalar(normal(k));
    motion.omega(k) = speed * normal(k);
    motion.alpha(k) = acceleration * normal(k);
  }
}

/// A w̃
template <class Scalar>
Matrix3<Scalar> times_skew(const Matrix3<Scalar>& A, const Vector3<Scalar>& w) {
  Matrix3<Scalar> product;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int next = (j + 1) % 3, last = (j + 2) % 3;
      product(i, j) = w(last) * A(i, next) - w(next) * A(i, last);
    }
  }
  return product;
}

/// Derivatives of A are those with respect to right perturbations: dual parts of ψ stand for δ.
template <class Scalar>
void set_spatial_motion(const Vector3<Scalar>& psi, const Vector3<Scalar>& omega,
                        const Vector3<Scalar>& alpha, FrameMotion<Scalar>& motion) {
  const Eigen::Vector3d fixed = value_matrix(psi);
  motion.A = rotation_of(fixed).template cast<Scalar>();
  if constexpr (!std::is_same_v<Scalar, double>) {
    Vector3<Scalar> perturbation;
    for (int i = 0; i < 3; ++i) perturbation(i) = psi(i) - fixed(i);
    motion.A += times_skew<Scalar>(motion.A, perturbation);
  }
  motion.A_dot = times_skew<Scalar>(motion.A, omega);
  motion.A_ddot = times_skew<Scalar>(motion.A, alpha) + times_skew<Scalar>(motion.A_dot, omega);
  for (int i = 0; i < 3; ++i) {  // A ẽᵢ
    Matrix3<Scalar>& by_turn = motion.A_p[i];
    by_turn.col(i).setConstant(Scalar(0));
    by_turn.col((i + 1) % 3) = motion.A.col((i + 2) % 3);
    by_turn.col((i + 2) % 3) = -motion.A.col((i + 1) % 3);
  }
  motion.G = Matrix3<double>::Identity().template cast<Scalar>();
  motion.omega = omega;
  motion.alpha = alpha;
}

}  // namespace frame_detail

template <class Scalar>
using Coordinates = Eigen::Ref<const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>;

/// Kinematics of a frame from its own coordinates (size() entries) and their rates.
template <class Scalar>
FrameMotion<Scalar> frame_motion(const BodyFrame& frame, const Coordinates<Scalar>& q,
                                 const Coordinates<Scalar>& v, const Coordinates<Scalar>& a) {
  FrameMotion<Scalar> motion;
  motion.r = frame.origin.template cast<Scalar>();
  motion.r_dot.setConstant(Scalar(0));
  motion.r_ddot.setConstant(Scalar(0));
  const int first = frame.translations();
  for (int i = 0; i < first; ++i) {
    for (int k = 0; k < 3; ++k) {
      const double direction = frame.basis(k, i);
      motion.r(k) += q(i) * direction;
      motion.r_dot(k) += v(i) * direction;
      motion.r_ddot(k) += a(i) * direction;
    }
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
      frame_detail::set_angle_motion<Scalar>(frame, q(first), v(first), a(first), motion);
      break;
    case RotationCoordinates::rotation_vector:
      frame_detail::set_spatial_motion<Scalar>(q.template segment<3>(first),
                                               v.template segment<3>(first),
                                               a.template segment<3>(first), motion);
      break;
  }
  return motion;
}

/// Compiled once.
extern template FrameMotion<double> frame_motion(const BodyFrame&, const Coordinates<double>&,
                                                 const Coordinates<double>&,
                                                 const Coordinates<double>&);
extern template FrameMotion<Dual> frame_motion(const BodyFrame&, const Coordinates<Dual>&,
                                               const Coordinates<Dual>&, const Coordinates<Dual>&);
extern template FrameMotion<WideDual> frame_motion(const BodyFrame&, const Coordinates<WideDual>&,
                                                   const Coordinates<WideDual>&,
                                                   const Coordinates<WideDual>&);

}  // namespace pleuel
