#pragma once

#include <utility>

#include "core/effects/body_equations.hpp"
#include "core/effects/floating_frame_residual.hpp"

namespace pleuel {

/// The equations for any motion of the frame, with a tangent derived by hand.
class GeneralBodyEquations final : public BodyEquations {
 public:
  GeneralBodyEquations(const BodyFrame& frame, const Invariants<double>& invariants);

  void evaluate(const BodyMotion& motion) override;
  void add_forces(const BodyMotion& motion, Eigen::VectorXd& residual) const override;
  void write_tangent(const BodyMotion& motion, const Weights& weights, double* entries) override;

 private:
  void set_frame_columns(const BodyMotion& motion, const Weights& weights);
  void set_elastic_columns(const BodyMotion& motion, const Weights& weights);
  void write_elastic_block(const BodyMotion& motion, const Weights& weights, double* entries) const;

  const BodyFrame& frame_;
  const Invariants<double>& invariants_;
  Eigen::MatrixXd elastic_;  ///< K, D, S_ff and S_kl, a column of non-zeros each

  // Scratch.
  BodyProducts products_;        ///< of the motion evaluated last
  Eigen::MatrixXd frame_block_;  ///< m × m
  /// The coupling of m frame coordinates with elastic coordinate i is this times column i of
  /// BodyProducts::coupling: entries (frame, i), then (i, frame); 2m × its rows.
  Eigen::MatrixXd coupling_;
};

/// Forces of dI/dx.
class GeneralDerivativeForces final : public DerivativeForces {
 public:
  GeneralDerivativeForces(const BodyFrame& frame, Invariants<double> derivative)
      : frame_(frame), derivative_(std::move(derivative)) {}

  void set_forces(const BodyMotion& motion, const ElasticMotion& elastic,
                  Eigen::VectorXd& forces) override {
    set_derivative_forces(derivative_, frame_, motion, elastic, forces);
  }

 private:
  const BodyFrame& frame_;
  Invariants<double> derivative_;
};

}  // namespace pleuel
