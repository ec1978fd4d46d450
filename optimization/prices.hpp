#pragma once

#include <Eigen/Core>

#include "optimization/result.hpp"

namespace pleuel {

/// Multipliers as prices of limits: 0 for a constraint whose value is further than 10⁻³ of its
/// magnitude from the limit that its multiplier belongs to. The audit lets limits with slack take
/// part and pay for it; moving such a limit a little changes nothing.
/// @param multipliers  of the constraints: μ of KktAudit
/// @param scales       magnitudes C of the constraints
Eigen::VectorXd prices_of(const Problem& problem, const Eigen::VectorXd& constraints,
                          const Eigen::VectorXd& multipliers, const Eigen::VectorXd& scales);

/// Makes a design the answer of a result, with the prices of its limits.
/// @param scales  magnitudes C of the constraints
void set_answer(Result& result, const Problem& problem, EvaluatedDesign design,
                const KktAudit& audit, const Eigen::VectorXd& scales);

/// Makes a design of which nothing is proven the answer: audited beside itself alone.
void set_unproven_answer(Result& result, const Problem& problem, EvaluatedDesign design,
                         const Eigen::VectorXd& scales);

/// Whether the multipliers of a result say what limits are worth: those of an optimum, and of a
/// design within the limits with a KKT residual of at most 10⁻². What explains the gradients of any
/// other design best is no price.
bool has_prices(const Result& result);

}  // namespace pleuel
