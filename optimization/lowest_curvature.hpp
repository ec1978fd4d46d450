#pragma once

#include <functional>
#include <optional>

#include <Eigen/Core>

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

}  // namespace pleuel
