#pragma once

#include <optional>

#include "optimization/evaluation_cache.hpp"
#include "optimization/kkt_audit.hpp"

namespace pleuel {

/// What was found around a design that fulfils the conditions of first order.
struct Neighbourhood {
  int dimension = 0;   ///< of the directions that the limits leave open to first order
  int directions = 0;  ///< of those, how many the curvature was computed along
  /// A design that keeps the limits and is better by more than was asked for.
  std::optional<Eigen::VectorXd> better;
  double gain = 0.0;  ///< how much lower its objective is, relative
  /// Whether the Lagrangian has neither slope nor curvature along any direction that was looked at.
  bool is_plateau = false;
  /// By how much the objective may come down by following what is left of the gradients, relative:
  /// ½ rᵀ H⁻¹ r in the directions that the limits leave open, see explore_neighbourhood().
  double gain_left = 0.0;
};

/// Looks whether a KKT point is a minimum, not a maximum or a saddle. In the tangent space of the
/// limits that hold it (those with multipliers, and equalities) it finds the direction d along
/// which the Lagrangian bends least, by Hessian-vector products from gradients
/// (lowest_curvature.hpp):
///
///     ∇²L d ≈ (∇L(x + h s ∘ d) − ∇L(x)) / h,   L = f + Σ μ c,   h = 0.02, s as for backends
///
/// and then goes both ways along it, with the limits restored by a Newton step on their gradients
/// at x, at h, 2h, 4h … up to 0.64 for as long as the objective falls. A direction that no limit
/// leaves costs nothing; else min(dimension, 6) gradients, one more where a bound without
/// multiplier is near, and two to four values, more only if the objective does fall. It is no
/// proof: beyond six dimensions directions remain unseen, and so does what lies further away.
///
/// The same products give what is left to be gained by the remaining slope r of the Lagrangian: for
/// each eigenvector of the reduced Hessian with curvature k the gain r²/2k, or r R − k R²/2 where
/// the minimum lies further off than R = 0.5 s; directions that were not looked at count with the
/// lowest curvature that was found.
/// @param least_gain  relative to |f| (at least 10⁻³ |f(start)|)
/// @param start       evaluation of the first design
Neighbourhood explore_neighbourhood(EvaluationCache& cache, const EvaluatedDesign& design,
                                    const KktAudit& audit, const Evaluation& start,
                                    double least_gain);

}  // namespace pleuel
