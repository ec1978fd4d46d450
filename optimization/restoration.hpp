#pragma once

#include <optional>

#include "optimization/problem.hpp"

namespace pleuel {

/// What a restoration may cost.
struct RestorationBudget {
  int gradients = 25;
  int evaluations = 60;
};

/// Leads a design into the limits, whatever the objective says, by the Levenberg–Marquardt method
/// on the squares of violations:
///
///     minimize Σ max(0, ψ(g) + margin)²     (ψ: phase_one_problem.hpp)
///
/// in the logarithms of variables with positive bounds: there ψ of stresses and deflections is
/// nearly linear in sizes. Each step minimizes the linearised sum within a box, the trust region,
/// which a failed evaluation or a step that does not help makes smaller.
/// @returns a design that exceeds no limit, and of equalities none by more than 1e-7; nothing if it ends
///          elsewhere, or if the start, or its gradients, cannot be evaluated
std::optional<Eigen::VectorXd> restore_limits(Problem& problem, const Eigen::VectorXd& start,
                                              const RestorationBudget& budget = {});

}  // namespace pleuel
