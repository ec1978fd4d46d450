#pragma once

#include "core/effects/body_equations.hpp"
#include "core/effects/planar_constants.hpp"

namespace pleuel {

/// The equations of a body whose frame turns by an angle, in the constants that are left of the
/// invariants then (planar_constants.hpp). Most of the time of planar simulations was spent in the
/// general equations, which are what tests compare these with.
class PlanarBodyEquations final : public BodyEquations {
 public:
  PlanarBodyEquations(const BodyFrame& frame, const Invariants<double>& invariants);

  void evaluate(const BodyMotion& motion) override;
  void add_forces(const BodyMotion& motion, Eigen::VectorXd& residual) const override;
  void write_tangent(const BodyMotion& motion, const Weights& weights, double* entries) override;

 private:
  using Basis = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>;

  void write_frame_block(const BodyMotion& motion, const Weights& weights, double* entries) const;
  template <int Rows>
  void write_coupling(const BodyMotion& motion, const Weights& weights, double* entries) const;
  void write_elastic_block(const Weights& weights, double* entries) const;

  const BodyFrame& frame_;
  PlanarConstants body_;
  Eigen::MatrixXd matrices_;  ///< PlanarConstants::matrices()

  // Of the motion evaluated last.
  PlanarProducts products_;
  Basis basis_;  ///< directions in which the frame moves, body axes
};

/// Forces of dI/dx.
class PlanarDerivativeForces final : public DerivativeForces {
 public:
  PlanarDerivativeForces(const BodyFrame& frame, const Invariants<double>& derivative)
      : frame_(frame), derivative_(frame, derivative) {}

  void set_forces(const BodyMotion& motion, const ElasticMotion& elastic,
                  Eigen::VectorXd& forces) override;

 private:
  const BodyFrame& frame_;
  PlanarConstants derivative_;
  PlanarProducts products_;  ///< scratch
};

}  // namespace pleuel
