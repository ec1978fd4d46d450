#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "optimization/problem.hpp"

/// Natural magnitudes of variables, constraints, and objective: what "relative" and "of order one"
/// mean in this folder.
namespace pleuel {

/// Magnitude s of each variable near the design x, for the backends: its own, or else |xᵢ|, but at
/// least a tenth of the range between its bounds and at most all of it; without finite bounds at
/// least |start|, or 1 if both are 0. Always positive.
Eigen::VectorXd variable_scales(const Problem& problem, const Eigen::VectorXd& x);

/// The same for the audit, with at least a hundredth of the range: a step of s is a change of a
/// small variable that an engineer would call large. Variables without finite bounds share the
/// largest of their magnitudes, since nothing says that one of them near 0 is meant to be small.
Eigen::VectorXd local_scales(const Problem& problem, const Eigen::VectorXd& x);

/// Magnitude C of each constraint: its larger finite limit, so that (c − upper)/C is σ/σ_allow − 1.
/// Where the limits are 0, the change of c with the variables, ‖s ∘ ∇c‖∞; where that vanishes too,
/// |c|, or 1. Always positive.
/// @param evaluation  at x, with gradients.
/// @param scales      s of variable_scales().
Eigen::VectorXd constraint_scales(const Problem& problem, const Evaluation& evaluation,
                                  const Eigen::VectorXd& scales);

/// s ∘ ∇f, the change of the objective with each variable; 0 for fixed variables.
Eigen::VectorXd scaled_objective_gradient(const Problem& problem, const Evaluation& evaluation,
                                          const Eigen::VectorXd& scales);

/// Magnitude F of the objective: max(|f|, ‖s ∘ ∇f‖∞), or 1 where both vanish. Always positive.
double objective_scale(const Problem& problem, const Evaluation& evaluation,
                       const Eigen::VectorXd& scales);

/// |f|, but not nothing where f vanishes at the optimum: at least a thousandth of that of the start.
double objective_value_scale(const Evaluation& evaluation, const Evaluation& start);

/// What a design is, with gradients; nullptr where it cannot be evaluated. Valid until the next call.
using EvaluateBeside = std::function<const Evaluation*(const Eigen::VectorXd& x)>;

/// Curvature of the objective: how far s ∘ ∇f changes with the variables, by the gradient of a design beside x.
/// A sum of squares may vanish at its optimum, and its slope with it; this says what is much of it. Zero where
/// nothing is known.
/// @param at  evaluation of x, with gradients
double objective_curvature(const Problem& problem, const Eigen::VectorXd& x, const Evaluation& at,
                           const EvaluateBeside& evaluate);

/// One side of a limit as g = sign · (c − limit) / C ≤ 0.
struct LimitSide {
  std::size_t constraint = 0;
  double sign = 1.0;
  double limit = 0.0;
  double magnitude = 1.0;  ///< C

  double violation(const Eigen::VectorXd& constraints) const {
    return sign * (constraints[constraint] - limit) / magnitude;
  }
};

/// Both sides of all limits that are finite.
/// @param magnitudes  C, one a constraint
std::vector<LimitSide> limit_sides(const Problem& problem, const Eigen::VectorXd& magnitudes);

/// max over constraints of the amount by which c leaves its limits, divided by C; 0 if none does.
double max_violation(const Problem& problem, const Eigen::VectorXd& constraints,
                     const Eigen::VectorXd& scales);

}  // namespace pleuel
