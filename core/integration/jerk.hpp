#pragma once

#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// The part j of the jerk q⃛ at initial values that the constraints prescribe,
///     M j + Φ_qᵀ μ = 0,   Φ_q j + D = 0
/// with D what the motion makes of Φ̈ while a stays as it is, by a difference over an interval τ:
///     D = (Φ̈(q ⊕ τv, v + τa, a, t + τ) − Φ̈(q, v, a, t)) / τ
/// As q⁺ errs by c h³ q⃛ in a step, Φ(q⁺) = 0 of index 3 keeps the velocities off the other
/// constraints by −c h² j all the time, so that they have to start there for multipliers without a
/// transient of O(h) (Arnold, Brüls & Cardona 2015). Motion along the constraints is left as it is.
class ConstrainedJerk {
 public:
  /// @param step  of the scheme [s]; τ is a thousandth of it
  /// @throws SimulationError if the equations are singular
  ConstrainedJerk(Mechanism& mechanism, const State& start, double step);

  /// j, n entries.
  const Eigen::VectorXd& value() const { return value_; }

  /// ∂j/∂x, n × variables, from the derivatives of q, v, a of the start.
  Eigen::MatrixXd differentiate(const Eigen::MatrixXd& q, const Eigen::MatrixXd& v,
                                const Eigen::MatrixXd& a) const;

 private:
  State moved() const;
  void solve(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> rhs) const;

  Mechanism& mechanism_;
  System& system_;
  State start_;
  double interval_;
  Eigen::VectorXd value_, multipliers_;
};

}  // namespace pleuel
