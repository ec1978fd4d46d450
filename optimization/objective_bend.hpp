#pragma once

#include <functional>

#include <Eigen/Core>

#include "optimization/problem.hpp"

namespace pleuel {

/// What a design is, with gradients; nullptr where it cannot be evaluated. Valid until the next call.
using EvaluateBeside = std::function<const Evaluation*(const Eigen::VectorXd& x)>;

/// How far s ∘ ∇f changes with the variables, of a design beside x. A sum of squares may vanish at
/// its optimum, and its slope with it; this says what is much of it. Zero where nothing is known.
/// @param at  evaluation of x, with gradients
double objective_bend(const Problem& problem, const Eigen::VectorXd& x, const Evaluation& at,
                      const EvaluateBeside& evaluate);

}  // namespace pleuel
