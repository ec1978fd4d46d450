#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// What all bodies of a model are built with.
struct BuildContext {
  const Scene& scene;
  const EffectSettings& effects;
  const Design<double>& start;
  const Design<double>& design;
  std::optional<MotionPlane> plane;
  Eigen::Vector3d gravity;

  int variables() const { return static_cast<int>(design.size()); }
  /// The design with one variable seeded.
  Design<Dual> seeded(int variable) const;
};

/// Frame and elastic coordinates of a body, beginning at `offset`.
BodyModel make_body_model(const Body& body, const BuildContext& context, int offset);

/// Inertia, elasticity and, for beams, geometric stiffening. Sets the derivatives of the mass.
std::vector<std::unique_ptr<Term>> make_body_terms(const Body& body, BodyModel& model,
                                                   const BuildContext& context);

/// Frame coordinates of a body at t = 0: translations, then angle or Euler parameters.
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
  } else if (frame.rotation == RotationCoordinates::euler_parameters) {
    q.tail(4) = euler_parameters<Scalar>(pose.rotation);
  }
  return q;
}

}  // namespace pleuel
