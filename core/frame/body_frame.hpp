#pragma once

#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/base/dual.hpp"

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
  none,             ///< a point mass has no orientation
  angle,            ///< A = R(axis, φ) A_ref: motion in a plane
  euler_parameters  ///< A(θ), θ = (e₀, e₁, e₂, e₃), |θ| = 1
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
        return 4;
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

/// Polarised rotation matrix of Euler parameters: bilinear, with A(θ) = A(θ, θ),
///     A(a, b) = (a₀b₀ − aᵀb) I + a bᵀ + b aᵀ + a₀ b̃ + b₀ ã       (vector parts a, b)
template <class Scalar>
Matrix3<Scalar> euler_bilinear(const Eigen::Matrix<Scalar, 4, 1>& a,
                               const Eigen::Matrix<Scalar, 4, 1>& b) {
  const Vector3<Scalar> av = a.template tail<3>(), bv = b.template tail<3>();
  const Scalar diagonal = a(0) * b(0) - av.dot(bv);
  Matrix3<Scalar> matrix =
      av * bv.transpose() + bv * av.transpose() + a(0) * skew<Scalar>(bv) + b(0) * skew<Scalar>(av);
  for (int i = 0; i < 3; ++i) matrix(i, i) += diagonal;
  return matrix;
}

/// ω = 2 L(θ) θ̇ in body axes, L(θ) = [−e, e₀ I − ẽ]; L(θ) θ = 0, so that α = 2 L(θ) θ̈.
template <class Scalar>
Eigen::Matrix<Scalar, 3, 4> euler_rate_matrix(const Eigen::Matrix<Scalar, 4, 1>& theta) {
  Eigen::Matrix<Scalar, 3, 4> matrix;
  matrix << -theta(1), theta(0), theta(3), -theta(2),  //
      -theta(2), -theta(3), theta(0), theta(1),        //
      -theta(3), theta(2), -theta(1), theta(0);
  return matrix;
}

/// Euler parameters of a rotation matrix (any, e₀ ≥ 0), in any scalar type.
template <class Scalar>
Eigen::Matrix<Scalar, 4, 1> euler_parameters(const Matrix3<Scalar>& rotation) {
  using std::sqrt;
  // Four candidates; the one with the largest divisor is taken (Shepperd 1978).
  const Scalar trace = rotation(0, 0) + rotation(1, 1) + rotation(2, 2);
  int best = -1;
  double largest = value_of(trace);
  for (int i = 0; i < 3; ++i) {
    if (value_of(rotation(i, i)) > largest) {
      largest = value_of(rotation(i, i));
      best = i;
    }
  }
  Eigen::Matrix<Scalar, 4, 1> theta;
  if (best < 0) {
    theta(0) = sqrt(1.0 + trace) / 2.0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      theta(1 + i) = (rotation(k, j) - rotation(j, k)) / (4.0 * theta(0));
    }
    return theta;
  }
  const int j = (best + 1) % 3, k = (best + 2) % 3;
  const Scalar e = sqrt(1.0 + 2.0 * rotation(best, best) - trace) / 2.0;
  theta(1 + best) = e;
  theta(0) = (rotation(k, j) - rotation(j, k)) / (4.0 * e);
  theta(1 + j) = (rotation(j, best) + rotation(best, j)) / (4.0 * e);
  theta(1 + k) = (rotation(k, best) + rotation(best, k)) / (4.0 * e);
  return theta;
}

/// Position, velocity and acceleration of a frame, with the derivatives that forces need.
template <class Scalar>
struct FrameMotion {
  Vector3<Scalar> r, r_dot, r_ddot;    ///< global axes
  Matrix3<Scalar> A, A_dot, A_ddot;    ///< exact time derivatives of A(coordinates)
  std::array<Matrix3<Scalar>, 4> A_p;  ///< ∂A/∂(rotation coordinate)
  Vector3<Scalar> omega, alpha;        ///< ω = G ṗ, α = G p̈, body axes
  Eigen::Matrix<Scalar, 3, Eigen::Dynamic, 0, 3, 4> G;                 ///< 3 × rotations
  Eigen::Matrix<Scalar, 3, Eigen::Dynamic, 0, 3, 4> omega_p, alpha_p;  ///< ∂ω/∂p, ∂α/∂p
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
  motion.omega_p.setConstant(3, 1, Scalar(0));
  motion.alpha_p.setConstant(3, 1, Scalar(0));
}

template <class Scalar>
void set_euler_motion(const Eigen::Matrix<Scalar, 4, 1>& theta,
                      const Eigen::Matrix<Scalar, 4, 1>& rate,
                      const Eigen::Matrix<Scalar, 4, 1>& acceleration,
                      FrameMotion<Scalar>& motion) {
  using Vector4 = Eigen::Matrix<Scalar, 4, 1>;
  motion.A = euler_bilinear(theta, theta);
  motion.A_dot = 2.0 * euler_bilinear(theta, rate);
  motion.A_ddot = 2.0 * euler_bilinear(rate, rate) + 2.0 * euler_bilinear(theta, acceleration);
  for (int i = 0; i < 4; ++i) {
    const Vector4 unit = Eigen::Vector4d::Unit(i).template cast<Scalar>();
    motion.A_p[static_cast<std::size_t>(i)] = 2.0 * euler_bilinear(theta, unit);
  }
  motion.G = 2.0 * euler_rate_matrix(theta);
  motion.omega = motion.G * rate;
  motion.alpha = motion.G * acceleration;
  motion.omega_p = -2.0 * euler_rate_matrix(rate);
  motion.alpha_p = -2.0 * euler_rate_matrix(acceleration);
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
      motion.omega_p.resize(3, 0);
      motion.alpha_p.resize(3, 0);
      break;
    case RotationCoordinates::angle:
      frame_detail::set_angle_motion<Scalar>(frame, q(k), v(k), a(k), motion);
      break;
    case RotationCoordinates::euler_parameters:
      frame_detail::set_euler_motion<Scalar>(q.template segment<4>(k), v.template segment<4>(k),
                                             a.template segment<4>(k), motion);
      break;
  }
  return motion;
}

}  // namespace pleuel
