#pragma once

#include <optional>

#include "optimization/evaluation_cache.hpp"
#include "optimization/problem.hpp"

namespace pleuel {

/// What a restoration may cost.
struct RestorationBudget {
  int gradients = 25;
  int evaluations = 60;
};

struct Restored {
  EvaluatedDesign design;      ///< with gradients; max_violation relative to the magnitudes
  Eigen::VectorXd magnitudes;  ///< C of the constraints, see scaling.hpp
  /// No limit is exceeded; of equalities none by more than 1e-7.
  bool keeps_limits = false;
};

/// Leads a design into the limits, whatever the objective says, by the Levenberg–Marquardt method
/// on the squares of violations:
///
///     minimize Σ max(0, ψ(g) + margin)²     (ψ: elastic_problem.hpp)
///
/// in the logarithms of variables with positive bounds: there ψ of stresses and deflections is
/// nearly linear in sizes. Each step minimizes the linearised sum within a box, the trust region,
/// which a failed evaluation or a step that does not help makes smaller.
/// @returns where it ends: within the limits, or where it can find no smaller sum; nothing if the
///          start, or its gradients, cannot be evaluated
std::optional<Restored> restore_limits(Problem& problem, const Eigen::VectorXd& start,
                                       const RestorationBudget& budget = {});

}  // namespace pleuel
