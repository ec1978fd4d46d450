#pragma once

#include "core/base/dense_solvers.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// Where constraints are redundant, the forces Φ_qᵀ λ of all joints together are determined, but
/// not which joint exerts them. Of all multipliers with the same forces these have the least norm,
///     λ = arg min λᵀ W λ   with   Φ_qᵀ λ = Φ_qᵀ λ₀
/// with W = Mechanism::reaction_weight, which makes that the sum of |F|² + |M|²/ℓ² of all joints
/// and drives. Each redundant row is a combination of the others, φ_i = Φ_qᵀ c_i, so that the
/// columns n_i = e_i − c_i of N span what exerts no force, Φ_qᵀ N = 0, and
///     λ = λ₀ − N (Nᵀ W N)⁻¹ Nᵀ W λ₀
class LeastNorm {
 public:
  /// @param mechanism  with constraints that are left out; must outlive this
  explicit LeastNorm(const Mechanism& mechanism);

  /// Goes to an instant; nothing is done if it is there. @throws SimulationError if the constraints
  /// that are kept are dependent
  void set(const State& state);

  /// λ of the multipliers of the instant.
  Eigen::VectorXd apply(const Eigen::VectorXd& multipliers) const;

  /// How a function of λ with the gradient g changes with λ₀ and with G = Φ_q. As W λ = G y for
  /// some y,
  ///     gᵀ δλ = (G α)ᵀ δλ₀ + αᵀ δGᵀ (λ₀ − λ) + yᵀ δGᵀ β,
  ///     β = N (Nᵀ W N)⁻¹ Nᵀ g,   G α = g − W β
  /// along any change that keeps the constraints redundant.
  struct Slope {
    Eigen::VectorXd lambda;      ///< G α (m)
    Eigen::VectorXd alpha, y;    ///< (n)
    Eigen::VectorXd left, beta;  ///< λ₀ − λ and β (m)
  };
  Slope slope(const Eigen::VectorXd& multipliers, const Eigen::VectorXd& g);

 private:
  /// N (Nᵀ W N)⁻¹ Nᵀ b.
  Eigen::VectorXd share(const Eigen::VectorXd& b) const;
  /// The smallest x with G x = b.
  Eigen::VectorXd motion(const Eigen::VectorXd& b);

  const Mechanism& mechanism_;
  System& system_;
  System::Matrix matrix_;
  LinearSolver solver_;
  State position_;
  bool is_set_ = false;
  Eigen::MatrixXd forceless_;  ///< N, m × left out
  Cholesky weights_;
};

}  // namespace pleuel
