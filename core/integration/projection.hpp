#pragma once

#include <array>

#include "core/integration/state_columns.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/system/linear_forces.hpp"

namespace pleuel {

/// What ends a step of index 1 that is to keep its joints together: the smallest changes of
/// positions and velocities that lead back to the constraints (Hairer & Wanner 1996, ch. VII.2),
///     q* = q ⊕ δ,   W δ + Φ_q(q)ᵀ η = 0,        Φ(q*) = 0
///     v* = v + ε,   M(q*) ε + Φ_q(q*)ᵀ ν = 0,   Φ̇(q*, v*) = 0
/// Positions by the weights W of the assembly, which move frames rather than deform bodies; with
/// masses it would be the light nodes at the joints of stiff members that give way, to ring. But
/// velocities by masses: −ν are then the impulses of a velocity that jumps. What changes is what
/// the step erred, so that the scheme keeps its order. a and λ stay as they are.
class Projection {
 public:
  explicit Projection(const Mechanism& mechanism);

  /// Projects q and v of a state. Allocates nothing. @returns whether it has converged
  bool apply(State& state);

  /// Of positions and of velocities: what results depend on besides the state.
  std::array<LinearSolver*, 2> solvers() { return {&position_solver_, &velocity_solver_}; }

  // Sensitivities, at a state before the projection.

  /// @throws SimulationError if the constraints are dependent there
  void linearize(const State& drifted);
  /// Derivatives before to those after the projection, n × columns.
  void differentiate(Eigen::MatrixXd& q, Eigen::MatrixXd& v,
                     DerivativesOf of = DerivativesOf::design);
  /// The transposed of it: derivatives of functions with respect to q* and v* to those with respect
  /// to q and v (n × functions), and the parameter adjoints (System::add_parameter_adjoints).
  void differentiate_transposed(Columns q, Columns v, Columns sums);

 private:
  /// The change of positions or of velocities, and the multipliers that make it.
  struct Change {
    Eigen::VectorXd move, multipliers;
    void set_zero(const System& system);
  };
  bool close_positions();
  bool close_velocities();
  /// Adds to a change what closes constraints that are open by the tail of residual_. @returns its
  /// size relative to the scale of the coordinates
  double correct(LinearSolver& solver, Change& change);

  const Mechanism& mechanism_;
  System& system_;
  System::Matrix matrix_;
  LinearSolver position_solver_, velocity_solver_;
  State drifted_, at_rest_;  ///< before and after, with v, a and λ zero
  State projected_;
  Eigen::VectorXd start_;  ///< velocities before
  Change delta_, epsilon_;
  Eigen::VectorXd residual_, step_;

  // Of linearize():
  System::Matrix position_rows_;  ///< Φ_q(q*) T(δ)
  System::Matrix velocity_rows_;  ///< Φ_q(q*)
  System::Matrix rate_rows_;      ///< Φ̇_q(q*, v*)
  LinearForces position_forces_;  ///< Φ_q(q)ᵀ η
  LinearForces velocity_forces_;  ///< M(q*) ε + Φ_q(q*)ᵀ ν
  System::Matrix position_forces_q_, velocity_forces_q_;
};

}  // namespace pleuel
