#pragma once

#include "core/beam/invariants.hpp"
#include "core/frame/body_frame.hpp"
#include "core/system/term.hpp"

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

/// Forces and tangents of one body in the floating frame of reference formulation, written for one
/// kind of motion of its frame. The equations stand in general_body_equations.hpp.
class BodyEquations {
 public:
  virtual ~BodyEquations() = default;

  /// What forces and tangents of one motion share. They expect the motion evaluated last.
  virtual void evaluate(const BodyMotion& motion) = 0;

  /// residual.segment(frame.offset, …) += [ basisᵀ A f ; Gᵀ T ; F ]
  virtual void add_forces(const BodyMotion& motion, Eigen::VectorXd& residual) const = 0;

  /// w.q R_q + w.v R_v + w.a R_a in the order of declare_body_entries().
  virtual void write_tangent(const BodyMotion& motion, const Weights& weights, double* entries) = 0;
};

/// Forces of the derivative of a body's invariants with respect to one variable: the residual is
/// linear in them.
class DerivativeForces {
 public:
  virtual ~DerivativeForces() = default;

  /// @param motion   of the body; its elastic coordinates are not read
  /// @param elastic  of the coordinates that the derivative has
  /// @param forces   frame, then those coordinates; overwritten
  virtual void set_forces(const BodyMotion& motion, const ElasticMotion& elastic,
                          Eigen::VectorXd& forces) = 0;
};

/// The pattern of the tangent of a body: its frame, then for each elastic coordinate its column and
/// its row of the coupling with the frame, then the non-zeros of the elastic coordinates.
void declare_body_entries(const BodyFrame& frame, const ElasticPattern& pattern,
                          EntryList& entries);

}  // namespace pleuel
