#pragma once

#include <array>

#include "core/frame/body_frame.hpp"

namespace pleuel {

enum class TimeDerivative { none, first, second };

/// Position of a place of a body, or its velocity or acceleration, global axes.
/// @param p  in the frame, with its rates
template <class Scalar>
Vector3<Scalar> place_motion(const FrameMotion<Scalar>& frame,
                             const std::array<Vector3<Scalar>, 3>& p, TimeDerivative derivative) {
  switch (derivative) {
    case TimeDerivative::none:
      return frame.r + frame.A * p[0];
    case TimeDerivative::first:
      return frame.r_dot + (frame.A_dot * p[0] + frame.A * p[1]);
    default:
      return frame.r_ddot + (frame.A_ddot * p[0] + 2.0 * (frame.A_dot * p[1]) + frame.A * p[2]);
  }
}

/// a = Aᵀ(r̈ − g) + α × p + ω × (ω × p + 2 ṗ) + p̈: what the inertia load of a place comes from,
/// local axes.
template <class Scalar>
Vector3<Scalar> local_acceleration(const FrameMotion<Scalar>& frame, const Eigen::Vector3d& gravity,
                                   const std::array<Vector3<Scalar>, 3>& p) {
  const Vector3<Scalar> spin = frame.omega.cross(p[0]) + 2.0 * p[1];
  return p[2] + frame.alpha.cross(p[0]) + frame.omega.cross(spin) +
         frame.A.transpose() * (frame.r_ddot - gravity.template cast<Scalar>());
}

}  // namespace pleuel
