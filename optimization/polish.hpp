#pragma once

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

}  // namespace pleuel
