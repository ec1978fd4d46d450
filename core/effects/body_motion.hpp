#pragma once

#include "core/frame/body_frame.hpp"

namespace pleuel {

/// Elastic coordinates and rates (n).
struct ElasticMotion {
  Eigen::VectorXd q, v, a;
};

/// What the accelerations of the material points of a body are made of, in body axes:
///     a = a₀ + X p + Y ṗ + p̈,   a₀ = Aᵀ(r̈ − g),  X = α̃ + ω̃ω̃,  Y = 2ω̃,  p = p₀ + S q_f
struct BodyMotion : ElasticMotion {
  FrameMotion<double> frame;
  Eigen::Vector3d a0;  ///< [m/s²]
  Eigen::Matrix3d X, Y;
};

/// @param q, v, a  of the body: frame, then elastic coordinates
/// @param gravity  [m/s²], global axes
void set_body_motion(const BodyFrame& frame, const Eigen::Vector3d& gravity,
                     const Coordinates<double>& q, const Coordinates<double>& v,
                     const Coordinates<double>& a, BodyMotion& motion);

}  // namespace pleuel
