#pragma once

#include "core/integration/step_equations.hpp"

namespace pleuel {

/// The state that Newton's method begins a step with: y⁺ = history · y (for q as q ⊕ increment),
/// then the correction that leads to the acceleration expected. a and λ are expected on a straight
/// line through the last two states. Coordinates in which the equations are linear may ring or
/// jump: they are right after one iteration wherever it begins.
class Predictor {
 public:
  explicit Predictor(const StepEquations& equations) : correction_(equations.size()) {}

  /// @param time       the end of the step [s]
  /// @param equations  those of the step
  void predict(const StepState& old, double time, const Scheme& scheme,
               const StepEquations& equations, StepState& state);

  /// Takes note of a step that was accepted.
  void record(const StepState& old, const StepState& state);
  bool looks_ahead() const { return experience_.step > 0.0; }
  /// Expects the accelerations that are, until a step is recorded.
  void forget() { experience_.step = 0.0; }

  /// How the last step went.
  struct Experience {
    double step = 0.0;                 ///< its size [s]; 0: there is none
    Eigen::VectorXd change_of_a;       ///< from its start to its end (n)
    Eigen::VectorXd change_of_lambda;  ///< (m)
  };
  const Experience& experience() const { return experience_; }
  void set_experience(const Experience& experience) { experience_ = experience; }

 private:
  Experience experience_;
  Eigen::VectorXd correction_;  ///< scratch
};

}  // namespace pleuel
