#pragma once

#include <memory>

#include "core/model/build_context.hpp"
#include "core/model/model.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// Frame and elastic coordinates of a body, beginning at `offset`.
/// @throws SimulationError if there is no such body at this design (core/scene/body_rules.hpp)
BodyModel make_body_model(const Body& body, const BuildContext& context, int offset);

/// Inertia, elasticity, damping and weight.
std::unique_ptr<Term> make_body_term(const BodyModel& model, const BuildContext& context);

/// Frame coordinates of a body at t = 0: translations, then angle or rotation vector.
template <class Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, 1> frame_coordinates(const BodyFrame& frame,
                                                           const Pose<Scalar>& pose) {
  using std::atan2;
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> q(frame.size());
  const Vector3<Scalar> offset = pose.origin - frame.origin.template cast<Scalar>();
  const int k = frame.translations();
  for (int i = 0; i < k; ++i) {
    q(i) = Vector3<Scalar>(frame.basis.col(i).template cast<Scalar>()).dot(offset);
  }
  if (frame.rotation == RotationCoordinates::angle) {
    // A = R(axis, φ) A_ref: compare where both put the same in-plane vector.
    Eigen::Vector3d local = frame.reference.transpose() * frame.basis.col(0);
    const Vector3<Scalar> turned = pose.rotation * local.template cast<Scalar>();
    const Eigen::Vector3d normal = frame.axis.cross(frame.basis.col(0));
    const Scalar c = turned.dot(Vector3<Scalar>(frame.basis.col(0).template cast<Scalar>()));
    const Scalar s = turned.dot(Vector3<Scalar>(normal.template cast<Scalar>()));
    q(k) = atan2(s, c);
  } else if (frame.rotation == RotationCoordinates::rotation_vector) {
    const Eigen::Matrix3d rotation = value_matrix(pose.rotation);
    const Eigen::Vector3d psi = rotation_vector(rotation);
    for (int i = 0; i < 3; ++i) q(k + i) = Scalar(psi(i));
    if constexpr (std::is_same_v<Scalar, Dual>) {
      // Dual parts of rotation vectors are right perturbations: Aᵀ dA = δ̃.
      const Eigen::Matrix3d spin = rotation.transpose() * derivative_matrix(pose.rotation);
      q(k).derivatives()[0] = spin(2, 1);
      q(k + 1).derivatives()[0] = spin(0, 2);
      q(k + 2).derivatives()[0] = spin(1, 0);
    }
  }
  return q;
}

/// Rates of the frame coordinates at t = 0 that the scene asks for.
template <class Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, 1> frame_rates(const BodyFrame& frame, const Body& body,
                                                     const Design<Scalar>& design) {
  Vector3<Scalar> velocity = resolve_point(body.velocity, design);
  const Vector3<Scalar> spin = resolve_point(body.angular_velocity, design);
  if (const auto* beam = std::get_if<BeamBody>(&body.shape); beam != nullptr && beam->part) {
    velocity += spin.cross(part_offset(*beam, design));
  }
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> v(frame.size());
  const int k = frame.translations();
  for (int i = 0; i < k; ++i) {
    v(i) = Vector3<Scalar>(frame.basis.col(i).template cast<Scalar>()).dot(velocity);
  }
  if (frame.rotation == RotationCoordinates::angle) {
    v(k) = Vector3<Scalar>(frame.axis.template cast<Scalar>()).dot(spin);
  } else if (frame.rotation == RotationCoordinates::rotation_vector) {
    v.tail(3) = body_pose(body, design).rotation.transpose() * spin;
  }
  return v;
}

}  // namespace pleuel
