#pragma once

#include <functional>
#include <optional>

#include <Eigen/Core>

#include "optimization/evaluation_cache.hpp"
#include "optimization/verdict.hpp"

namespace pleuel {

/// The backend that polishes. Its steps near an optimum are those of Newton's method on the KKT
/// conditions, with the Hessian that it learns.
inline constexpr const char* polisher = "nlopt-slsqp";

/// Whether a design is so near an optimum that a few steps are likely to prove or improve it:
/// limits nearly kept, KKT residual below 0.1, and either unproven, or proven with more than a
/// tenth of Tolerances::gain left.
bool is_worth_polishing(const Verdict& verdict, const Tolerances& tolerances);

/// Iterations and evaluations of the whole run.
struct PolishBudget {
  int iterations = 0;
  int evaluations = 0;
};

/// Goes on from a design with the polisher and a tight tolerance, in variables that are balanced:
/// with the terms T of the audit, each s_i is multiplied with √(T_max / T_i), since a part of the
/// objective has a curvature of about its terms. A Hessian near 1 is what the polisher begins with;
/// small parts would come after many steps only.
/// @returns the design where it ends, within its bounds
Eigen::VectorXd polish(EvaluationCache& cache, const EvaluatedDesign& from, const KktAudit& audit,
                       const PolishBudget& budget);

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

}  // namespace pleuel
