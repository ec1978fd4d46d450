#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

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

}  // namespace pleuel
