#pragma once

#include "core/integration/linear_solver.hpp"
#include "core/integration/mechanism.hpp"

namespace pleuel {

/// What ends a step of index 1 that is to keep its joints together: the changes of positions and
/// velocities of least kinetic energy that lead back to the constraints (Hairer & Wanner 1996,
/// ch. VII.2; M and Φ_q of where the step ended, so that one matrix serves both),
///     q* = q ⊕ δ,   M(q) δ + Φ_q(q)ᵀ η = 0,   Φ(q*) = 0
///     v* = v + ε,   M(q) ε + Φ_q(q)ᵀ ν = 0,   Φ̇(q*, v*) = 0
/// It changes q and v by what the step erred in them, so that the scheme keeps its order; −ν are
/// the impulses of a velocity that jumps. a and λ stay as they are.
class Projection {
 public:
  explicit Projection(Mechanism& mechanism);

  /// Projects q and v of a state. Allocates nothing. @returns whether it has converged
  bool apply(State& state);

  /// Of the projection itself: what its results depend on besides the state.
  LinearSolver& solver() { return solver_; }

  // Sensitivities, at a state before the projection.

  /// @throws SimulationError if the constraints are dependent there
  void linearize(const State& drifted);
  /// Derivatives before to those after the projection, n × variables.
  void differentiate(Eigen::MatrixXd& q, Eigen::MatrixXd& v);
  /// The transposed of it: derivatives of functions with respect to q* and v* to those with respect
  /// to q and v (n × functions), and the design sums (System::add_design_sums).
  void pull_back(Columns q, Columns v, Columns sums);

 private:
  bool close_positions();
  bool close_velocities();
  /// Adds to a move and its multipliers what closes constraints that are open by the tail of
  /// residual_. @returns its size relative to the scale of the coordinates
  double correct(Eigen::VectorXd& move, Eigen::VectorXd& multipliers);
  void set_solver(const System::Matrix& rows, LinearSolver& solver);
  /// M(q) move + Φ_q(q)ᵀ multipliers, which is what of R is linear in a and λ.
  struct Pull {
    const Eigen::VectorXd &move, &multipliers;
  };
  void set_pull_tangent(const Pull& pull, System::Matrix& tangent);
  Eigen::MatrixXd pull_x(const Pull& pull);
  void add_pull_sums(const Pull& pull, const ConstColumns& mu, Columns sums);
  void hold(const Pull& pull);
  void release();
  void add_constraint_sums(ConstraintLevel level, const ConstColumns& mu, Columns sums);

  Mechanism& mechanism_;
  System& system_;
  System::Matrix matrix_;
  LinearSolver solver_;
  State drifted_;  ///< before, with v, a and λ zero
  State projected_;
  Eigen::VectorXd start_;  ///< velocities before
  Eigen::VectorXd delta_, eta_, epsilon_, nu_;
  Eigen::VectorXd residual_, step_;

  // Of linearize():
  LinearSolver velocity_solver_;
  System::Matrix position_rows_;  ///< Φ_q(q*) T(δ)
  System::Matrix velocity_rows_;  ///< Φ_q(q*)
  System::Matrix rate_rows_;      ///< Φ̇_q(q*, v*)
  /// (M δ + Φ_qᵀ η)_q and (M ε + Φ_qᵀ ν)_q.
  System::Matrix pull_q_of_positions_, pull_q_of_velocities_;
  System::Matrix scratch_;
};

}  // namespace pleuel
