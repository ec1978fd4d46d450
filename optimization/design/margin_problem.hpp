#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/trust/finding.hpp"
#include "optimization/design/design_problem.hpp"

namespace pleuel {

/// A problem made of that of a file, with the margins that its constraints ask for ("deviations").
/// @param problem            must outlive what is returned
/// @param constraint_of_row  the constraint of the file that each row of `problem` is of
/// @returns nothing if no constraint asks for any
/// @throws InputError if gradients are differences: those of differences would be noise
std::unique_ptr<Problem> with_margins(
    Problem& problem, const DesignProblem& design,
    const std::vector<std::optional<std::size_t>>& constraint_of_row);

/// Margins of limits (`deviations`) are those of first order: of what an uncertain parameter changes
/// the same way on both sides, as a side force does at zero, they know nothing. By simulations at k
/// deviations of each parameter to either side, two a parameter and k, for
///     ½ (c(x + kσᵢ) + c(x − kσᵢ)) − c(x)
/// towards the limit; of an interval no further than its ends. Told from a hundredth of the limit
/// on, serious from a twentieth. Told, too, where a value changes to one side only: at frequencies
/// or peaks that coincide the gradient is a mean.
std::vector<Finding> check_margins(DesignProblem& design, const Eigen::VectorXd& x);

}  // namespace pleuel
