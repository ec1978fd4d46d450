#pragma once

#include "optimization/problem.hpp"

namespace pleuel {

/// A problem whose limits hold with a margin: where the variables scatter independently with the
/// deviations σ_i, the value c of a constraint is c with, to first order,
///     σ_c² = Σ_i (σ_i ∂c/∂x_i)²,
/// and limited is c + k σ_c (of an upper limit; c − k σ_c of a lower one). Its gradient takes
/// second derivatives, those of direction i by central differences of gradients over ±1e-4 |x_i|
/// (or of a hundredth of the range, if that is more):
///     ∂σ_c/∂x = 1/σ_c Σ_i σ_i² ∂c/∂x_i ∂(∂c/∂x)/∂x_i
/// Values cost a gradient, gradients 1 + 2 · (number of uncertain variables) of them.
/// The sensitivities of c that make σ_c are those of this design only: see `uncertainty` with
/// samples for how far first order holds.
class RobustProblem : public FunctionProblem {
 public:
  /// @param deviations  σ, one a variable; 0: certain
  /// @param margins     k ≥ 0, one a constraint; each with k > 0 has one limit
  /// @param problem     must outlive this
  RobustProblem(Problem& problem, Eigen::VectorXd deviations, Eigen::VectorXd margins);

  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override;

 private:
  Eigen::MatrixXd deviation_gradients(const Eigen::VectorXd& x, const Evaluation& evaluation,
                                      const Eigen::VectorXd& deviations);

  Eigen::MatrixXd neighbour_jacobian(const Eigen::VectorXd& x, Eigen::Index changed);

  Problem& problem_;
  Eigen::VectorXd deviations_;
  Eigen::VectorXd margins_;  ///< of a lower limit with the sign −
  Eigen::VectorXd x_;        ///< of at_x_; empty before
  Evaluation at_x_;          ///< of the problem, with gradients
};

}  // namespace pleuel
