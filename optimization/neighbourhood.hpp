#pragma once

#include <functional>
#include <optional>

#include <Eigen/Core>

#include "optimization/evaluation_cache.hpp"
#include "optimization/kkt_audit.hpp"

namespace pleuel {

/// Where a quadratic form bends least among the directions that were looked at.
struct LowestCurvature {
  Eigen::VectorXd direction;   ///< of length 1; empty if no product could be had
  double curvature = 0.0;      ///< dᵀ H d
  int products = 0;            ///< with H that were made
  Eigen::MatrixXd directions;  ///< Q, orthonormal columns: those that were looked at
  Eigen::MatrixXd form;        ///< Qᵀ H Q, symmetric
};

/// H d for a d of length 1; nullopt if it cannot be had.
using HessianProduct = std::function<std::optional<Eigen::VectorXd>(const Eigen::VectorXd&)>;

/// The smallest eigenvalue of H in a subspace, by Lanczos' method with full reorthogonalisation
/// (Golub & Van Loan, Matrix Computations, 2013, ch. 10), begun with a generic direction that is
/// the same in every run. As many products as the subspace has dimensions make it exact; with fewer
/// it is an upper bound, since extreme eigenvalues are found first but not at once.
/// @param basis  of the subspace, orthonormal columns; at least one
LowestCurvature lowest_curvature(const HessianProduct& product, const Eigen::MatrixXd& basis,
                                 int max_products);

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
/// which the Lagrangian bends least, by Hessian-vector products from gradients (lowest_curvature()):
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
