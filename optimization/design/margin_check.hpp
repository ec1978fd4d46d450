#pragma once

#include <vector>

#include "core/trust/finding.hpp"
#include "optimization/design/design_problem.hpp"

namespace pleuel {

/// Margins of limits (`deviations`) are those of first order: of what an uncertain parameter changes
/// the same way on both sides, as a side force does at zero, they know nothing. By simulations at k
/// deviations of each parameter to either side, two a parameter and k, for
///     ½ (c(x + kσᵢ) + c(x − kσᵢ)) − c(x)
/// towards the limit; of an interval no further than its ends. Told from a hundredth of the limit
/// on, serious from a twentieth. Told, too, where a value changes to one side only: at frequencies
/// or peaks that coincide the gradient is a mean.
std::vector<Finding> check_margins(DesignProblem& design, const Eigen::VectorXd& x);

}  // namespace pleuel
