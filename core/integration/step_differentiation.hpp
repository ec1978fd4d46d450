#pragma once

#include <optional>

#include "core/integration/corner_jump.hpp"
#include "core/integration/projection.hpp"
#include "core/integration/step_equations.hpp"
#include "core/integration/trajectory.hpp"
#include "core/mechanism/linear_solver.hpp"

namespace pleuel {

/// Derivatives of the discrete motion, from step to step: exact for the steps that were taken, not
/// for the differential equation behind them. With the predicted part ŝ = history · s of the
/// differentiated scheme, at the converged state of each step
///     [ s(β'M + γ'C + K)  Φ_qᵀ ; Φ_q  0 ] [s_q; s s_λ]⁺ = −[ s (R_x + M ŝ_a + C ŝ_v); Φ_x ]
/// One factorisation a step, all columns as one block. Decoupled from the finite-element model: R_x
/// comes from the invariants' derivatives (Gufler, Wehrle & Vidoni 2022).
class StepDifferentiation {
 public:
  /// @param trajectory  of simulate() for the same mechanism; it has to stay
  StepDifferentiation(const Mechanism& mechanism, const Trajectory& trajectory, DerivativesOf of);

  /// Sets out from an instant.
  /// @param start  derivatives there, one column a design variable or, of the old state, any number
  void begin(StateSensitivity start, int instant = 0);

  /// One step further, unless the trajectory ends.
  /// @throws SimulationError if the step matrix is singular
  bool advance();

  /// The instant that is reached.
  int step() const { return step_; }
  const State& state() const { return state_; }
  const StateSensitivity& sensitivity() const { return sensitivity_; }

 private:
  void pass_corner();
  void predict();
  void solve();
  void swap_projected();
  void project();

  System& system_;
  const std::vector<int>& rotations_;
  const Trajectory& trajectory_;
  DerivativesOf of_;
  int step_ = 0;
  StateSensitivity sensitivity_, old_;
  Eigen::MatrixXd old_q_x_;
  Scheme scheme_;
  StepEquations equations_;
  StepState state_;
  Eigen::VectorXd old_q_;
  System::Matrix matrix_;
  LinearSolver solver_;
  Eigen::MatrixXd rhs_;
  std::optional<Projection> projection_;
  std::optional<CornerJump> corner_;
};

}  // namespace pleuel
