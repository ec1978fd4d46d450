#pragma once

#include <string>

#include "optimization/evaluation_cache.hpp"
#include "optimization/kkt_audit.hpp"

namespace pleuel {

/// How far the gradients that an audit relied on are from differences of the values.
struct GradientCheck {
  bool is_possible = false;  ///< false: the designs beside this one could not be evaluated
  double error = 0.0;        ///< relative to the gradient scale of the audit
  std::string worst;         ///< name of the objective or constraint with the largest error
};

/// Directional derivatives along generic directions d by the one-sided formula of second order,
///
///     ∂f/∂d ≈ (−3 f(x) + 4 f(x + h d) − f(x + 2 h d)) / 2h,   h |dᵢ| ≤ 10⁻³ |xᵢ|
///
/// against the gradients of the objective and of every constraint that has a multiplier, weighted
/// with it: what an optimum found with wrong gradients, or at a kink, cannot pass. Three directions
/// at 120° to each other in one plane (inwards at bounds), so that both sides of a kink are seen;
/// opposite ones if there is one variable. Where the error along one is not good enough, a tenth of
/// h is tried, since values that ring with the design have large third derivatives: the smaller
/// error counts. Six evaluations of values, twice as many where that happens. Errors across that
/// plane are not seen. The error estimates ‖s ∘ (error of ∇f)‖₂: a generic direction sees 1/√n of
/// it.
GradientCheck check_gradients(EvaluationCache& cache, const EvaluatedDesign& design,
                              const KktAudit& audit, double good_enough);

}  // namespace pleuel
