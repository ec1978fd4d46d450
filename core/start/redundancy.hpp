#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/base/dense_solvers.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// Misalignment of joints [rad, or of the mechanism's size] below which they count as aligned: far
/// below what anybody means by the numbers of a file, far above their round-off.
inline constexpr double alignment_tolerance = 1e-6;

/// Constraints that follow from the others wherever the mechanism can go, as in a planar loop of
/// spatial revolutes. Candidates are the rows of Φ_q that a rank-revealing factorisation leaves over at
/// the guess (core/base/sparse_rows.hpp; pivots up to the alignment tolerance); they are
/// redundant if they still hold, up to the tolerance, after a small motion in which only the others
/// are kept. So a position in which the mechanism is merely singular is told from redundancy. What
/// drives hold altogether is moved without them, too: a drive that starts from rest moves nothing,
/// and hides joints that are out of line. The guess has to meet the constraints.
/// @param drives  multipliers of drives
/// @returns indices of multipliers, ascending
std::vector<int> redundant_constraints(Mechanism& mechanism, const std::vector<int>& drives = {});

/// A constraint that would follow from others if joints were aligned exactly.
struct NearRedundancy {
  int constraint = 0;         ///< index of its multiplier
  std::vector<int> others;    ///< those from which it nearly follows
  double misalignment = 0.0;  ///< by which it opens with the motion that it blocks [rad, –]
  Eigen::VectorXd motion;     ///< that motion: what the others leave of the row, of length one (n)
};

/// Constraints that are kept, but block a motion only because joints are slightly out of line: they
/// open with the motion that the others leave by the misalignment, in proportion. (In a position
/// that is nearly singular they open with its square.) Elastic coordinates count with the
/// mechanism's size: bodies that yield are not locked. Drives are let go.
/// @param drives   multipliers of drives
/// @param largest  misalignment that is looked for
std::vector<NearRedundancy> nearly_redundant_constraints(const Mechanism& mechanism,
                                                         const State& state,
                                                         const std::vector<int>& drives,
                                                         double largest);

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
