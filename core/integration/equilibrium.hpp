#pragma once

#include "core/integration/initial_state.hpp"

namespace pleuel {

/// The equations of a start from elastic equilibrium: the mechanism begins to move as given, and
/// its members are deformed as if their elastic accelerations were zero, so that nothing rings.
/// Unknowns z = (q, v, a, λ, μ, ν); with e the elastic and r the other coordinates, W the weights
/// of the assembly:
///     R(q, v, a, λ) = 0,  Φ̈ = 0                  equations of motion
///     a_e = 0                                     no elastic acceleration
///     Φ(q) = 0,  W_r (q ⊖ q̂)_r + (Φ_qᵀ μ)_r = 0    the nearest frames that close the joints
///     Φ̇ = 0,     W (v − v̂) + Φ_qᵀ ν = 0            the nearest velocities
/// Newton's method and the derivatives with respect to the design use one and the same Jacobian.
class Equilibrium {
 public:
  explicit Equilibrium(Mechanism& mechanism);

  /// Starts from consistent initial values. @throws SimulationError if Newton's method fails
  InitialState solve(InitialState start);

  /// ∂z/∂x at a solution.
  struct Derivatives {
    Eigen::MatrixXd q, v, a, lambda;
  };
  Derivatives differentiate(const InitialState& solution);

  /// Of the equations, 3 (coordinates + multipliers) square. Its pattern is the same at all states:
  /// what is zero before members are deformed is stored, too.
  Eigen::SparseMatrix<double> jacobian(const InitialState& at) const;

 private:
  Eigen::VectorXd residual(const InitialState& at) const;
  Eigen::MatrixXd design_derivative(const InitialState& at) const;
  void advance_by(const Eigen::VectorXd& step, InitialState& at) const;

  Mechanism& mechanism_;
  System& system_;
  int n_, m_;
};

}  // namespace pleuel
