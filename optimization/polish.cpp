#include "optimization/polish.hpp"

#include <algorithm>

#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"

namespace pleuel {

namespace {

constexpr double near_optimum = 0.1;  ///< KKT residual
constexpr double near_limits = 1e-2;  ///< relative violation
constexpr double part_of_gain = 0.1;  ///< that is left of Tolerances::gain without a polish
constexpr double tolerance = 1e-10;   ///< a small part changes the objective by little
constexpr double least_terms = 1e-6;  ///< of T_max: balanced up to here
constexpr int consecutive_failures = 3;
/// Evaluations without gradients: near an optimum a full step does, or noise is all there is.
constexpr int line_search = 10;

Eigen::VectorXd balance(const KktAudit& audit) {
  const double largest = audit.terms.maxCoeff();
  if (!(largest > 0.0)) return Eigen::VectorXd::Ones(audit.terms.size());
  return (audit.terms / largest).cwiseMax(least_terms).cwiseInverse().cwiseSqrt();
}

}  // namespace

bool is_worth_polishing(const Verdict& verdict, const Tolerances& tolerances) {
  if (verdict.status == Status::verified) {
    return verdict.gain_left > part_of_gain * tolerances.gain;
  }
  return !verdict.gradients_are_disproved && !verdict.better_neighbour &&
         verdict.design.max_violation <= near_limits && verdict.audit.residual <= near_optimum;
}

Eigen::VectorXd polish(EvaluationCache& cache, const EvaluatedDesign& from, const KktAudit& audit,
                       const PolishBudget& budget) {
  return run_backend(cache, from, polisher, tolerance,
                     {budget.iterations, budget.evaluations, consecutive_failures, line_search, 0},
                     balance(audit))
      .x;
}

}  // namespace pleuel
