#pragma once

#include "optimization/design/size_lists.hpp"
#include "optimization/linear_choice.hpp"
#include "optimization/problem.hpp"
#include "optimization/result.hpp"

namespace pleuel {

/// What a linear model of sizes is made of.
struct SizeModelSettings {
  int down = 0, up = 0;            ///< sizes below and above those given that it may take
  bool is_reduced = false;         ///< other variables follow: the multipliers hold their share
  double relaxed_objective = 0.0;  ///< at the optimum between the sizes [SI]
};

/// The objective and the limits at choices of sizes around a design, from their gradients there. What
/// falls as a size grows, as a stress does, is taken to be linear in its reciprocal (Fleury & Braibant
/// 1986): c' · (y − x) · x / y. Where other variables follow, limits do not count: what keeping them
/// costs is in the slopes, df = (∇f + Jᵀμ) · dx.
/// @param at      evaluation with gradients at x, and multipliers if it is reduced
/// @param around  the sizes that the model's own are counted from
/// @param scales  of the constraints
LinearChoiceModel size_model(const SizeLists& lists, const Problem& problem,
                             const Eigen::VectorXd& x, const Result& at, const Sizes& around,
                             const Eigen::VectorXd& scales, const SizeModelSettings& settings);

}  // namespace pleuel
