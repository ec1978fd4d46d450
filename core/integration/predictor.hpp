#pragma once

#include "core/integration/step_equations.hpp"

namespace pleuel {

/// The state that Newton's method begins a step with: y⁺ = history · y (for q as q ⊕ increment),
/// then the correction that keeps the acceleration.
class Predictor {
 public:
  explicit Predictor(const StepEquations& equations) : correction_(equations.size()) {}

  /// @param time       the end of the step [s]
  /// @param equations  those of the step
  void predict(const StepState& old, double time, const Scheme& scheme,
               const StepEquations& equations, StepState& state) {
    const Eigen::Matrix4d& h = scheme.history;
    state.increment = h(0, 1) * old.v + h(0, 2) * old.a + h(0, 3) * old.w;
    state.v = h(1, 0) * old.q + h(1, 1) * old.v + h(1, 2) * old.a + h(1, 3) * old.w;
    state.a = h(2, 0) * old.q + h(2, 1) * old.v + h(2, 2) * old.a + h(2, 3) * old.w;
    state.w = h(3, 0) * old.q + h(3, 1) * old.v + h(3, 2) * old.a + h(3, 3) * old.w;
    state.shift.setZero();
    state.eta.setZero();
    correction_.setZero();
    correction_.head(old.q.size()) = (old.a - state.a) / scheme.correction(2);
    equations.apply(correction_, state);
    state.time = time;
  }

 private:
  Eigen::VectorXd correction_;
};

}  // namespace pleuel
