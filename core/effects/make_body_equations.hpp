#pragma once

#include <memory>

#include "core/effects/body_equations.hpp"

namespace pleuel {

/// The equations for any motion, for motion in a plane where the frame turns by an angle, or for a
/// mass that does not turn.
/// @param frame, invariants  must outlive the result
std::unique_ptr<BodyEquations> make_body_equations(const BodyFrame& frame,
                                                   const Invariants<double>& invariants);
/// Likewise.
/// @param frame  must outlive the result
std::unique_ptr<DerivativeForces> make_derivative_forces(const BodyFrame& frame,
                                                         Invariants<double> derivative);

/// The equations of a mass whose frame does not turn: m basisᵀ (r̈ − g), with a constant tangent.
class TranslatingBodyEquations final : public BodyEquations {
 public:
  /// @param frame  must outlive this
  TranslatingBodyEquations(const BodyFrame& frame, double mass)
      : frame_(frame), mass_(mass), mass_matrix_(mass * (frame.basis.transpose() * frame.basis)) {}

  void evaluate(const BodyMotion&) override {}
  void add_forces(const BodyMotion& motion, Eigen::VectorXd& residual) const override {
    residual.segment(frame_.offset, frame_.size()) +=
        frame_.basis.transpose() * (mass_ * (motion.frame.A * motion.a0));
  }
  void write_tangent(const BodyMotion&, const Weights& weights, double* entries) override {
    Eigen::Map<Matrix>(entries, frame_.size(), frame_.size()) = weights.a * mass_matrix_;
  }

 private:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
  const BodyFrame& frame_;
  double mass_;
  Matrix mass_matrix_;  ///< symmetric
};

}  // namespace pleuel
