#pragma once

#include <Eigen/Core>

#include "optimization/evaluation_cache.hpp"
#include "optimization/result.hpp"

namespace pleuel {

/// How well a design fulfils the conditions of Karush, Kuhn & Tucker, and the multipliers:
///
///     ∇f + Σⱼ μⱼ ∇cⱼ + β = 0,   μⱼ > 0 only at the upper limit of cⱼ, μⱼ < 0 only at its lower
///     one; β likewise at the bounds of the variables
struct KktAudit {
  /// μ, size = constraints; the shadow price: raising the active limit of cⱼ by 1 changes the
  /// optimal objective by −μⱼ. Unit of the objective / unit of the constraint.
  Eigen::VectorXd constraint_multipliers;
  /// β, size = variables; unit of the objective / unit of the variable.
  Eigen::VectorXd bound_multipliers;
  /// The larger one of ‖s ∘ (∇f + Σ μ ∇c + β)‖₂ / gradient_scale (stationarity) and
  /// Σ λ |g| / min(gradient_scale, |f|) (complementarity: for convex problems the part of the
  /// objective that slack leaves to be gained, or that violated limits have gained). |f| counts as
  /// at least 10⁻³ |f(start)|.
  double residual = 0.0;
  /// What residuals are compared with, in units of the objective; see audit_kkt().
  double gradient_scale = 0.0;

  /// The same of each variable in its own magnitude, so that a small part of the objective counts
  /// as much as a large one. In units of the objective, size = variables:
  ///     r_i = s_i (∂f/∂x_i + Σ μ_j ∂c_j/∂x_i + β_i)
  ///     T_i = s_i (|∂f/∂x_i| + Σ |μ_j ∂c_j/∂x_i| + |β_i|)
  Eigen::VectorXd stationarity;  ///< r
  Eigen::VectorXd terms;         ///< T
  /// The part of T_i that limits with slack pay, each times slack / ‖s ∘ ∇g‖₁: the relative change
  /// of the variables by which the limit is not reached.
  Eigen::VectorXd unpaid;
  /// Σ λ |g| [unit of the objective]: what slack leaves to be gained, and violation has gained.
  double complementarity = 0.0;

  /// max(|r_i|, unpaid_i) / max(T_i, κ_i) for each variable, where T_i counts as at least 10⁻⁵ of
  /// gradient_scale: below that lies the noise of gradients, and a variable that changes nothing.
  /// @param curvatures  κ, change of r_i with x_i / s_i, ≥ 0; empty: unknown. Where the objective
  ///                    alone makes a minimum, all terms of T_i vanish there and κ_i is its
  ///                    measure.
  Eigen::VectorXd variable_residuals(const Eigen::VectorXd& curvatures = {}) const;
};

/// Multipliers by nonnegative least squares on the gradients in scaled variables. All limits that
/// are within 10 % (of their magnitude) take part; one with slack pays for its multiplier with the
/// row λ · slack, so that no activity tolerance decides. Once with all rows alike, and once more
/// with each row divided by its T_i, since the multiplier of a limit on a small part drowns in the
/// residuals of large ones: the multipliers that explain the design better are taken.
///
/// gradient_scale is ‖s ∘ ∇f‖₂. Near an optimum without active limits this vanishes with the
/// residual: it is therefore at least min(G, |f| / 10), with the same floor of |f|, where G is the
/// larger one of ‖s ∘ ∇f(start)‖₂ and |f(start) − f|, since a start may be stationary; and at least
/// |f| / 1000. Fixed variables are in no balance: what limits leave of their slopes is their β.
/// @param design  with gradients of the true, un-aggregated constraints.
/// @param start   evaluation of the first design, with gradients.
/// @param scales  magnitudes C of the constraints.
KktAudit audit_kkt(const Problem& problem, const EvaluatedDesign& design, const Evaluation& start,
                   const Eigen::VectorXd& scales);

/// argmin ‖A z − b‖₂ over z ≥ 0 by the active-set method of Lawson & Hanson 1974, ch. 23. Columns
/// may be dependent or zero; their lengths do not matter.
/// @param matrix  A, rows × unknowns.
/// @param right   b, size = rows.
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& matrix,
                                          const Eigen::VectorXd& right);

/// Multipliers as prices of limits: 0 for a constraint whose value is further than 10⁻³ of its
/// magnitude from the limit that its multiplier belongs to. The audit lets limits with slack take
/// part and pay for it; moving such a limit a little changes nothing.
/// @param multipliers  of the constraints: μ of KktAudit
/// @param scales       magnitudes C of the constraints
Eigen::VectorXd prices_of(const Problem& problem, const Eigen::VectorXd& constraints,
                          const Eigen::VectorXd& multipliers, const Eigen::VectorXd& scales);

/// Makes a design the answer of a result, with the prices of its limits.
/// @param scales  magnitudes C of the constraints
void set_answer(Result& result, const Problem& problem, EvaluatedDesign design,
                const KktAudit& audit, const Eigen::VectorXd& scales);

/// Makes a design of which nothing is proven the answer: audited beside itself alone.
void set_unproven_answer(Result& result, const Problem& problem, EvaluatedDesign design,
                         const Eigen::VectorXd& scales);

}  // namespace pleuel
