#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/response/expression_value.hpp"
#include "core/scene/problem_file.hpp"

/// Responses that are made from those of several load cases (core/scene/load_cases.hpp).
namespace pleuel {

/// A number of each response of one case, by its place in the joined problem.
using ValueInCase = std::function<double(std::size_t)>;

/// Value of a response of a joined problem.
/// @param x  design variables [SI]
/// @throws SimulationError where it is not finite
double value_over_cases(const ProblemFile& joined, std::size_t response, const Eigen::VectorXd& x,
                        const ValueInCase& value_of);

/// The same to first order, by the chain rule through all expressions over cases:
///     d(value) = Σ weight · d(part) + design · dx
/// Each part is a response of one case, by its place in the joined problem; one of a single case is
/// its own only part.
/// @throws SimulationError where a derivative is not finite
LinearizedResponse linearized_over_cases(const ProblemFile& joined, std::size_t response,
                                         const Eigen::VectorXd& x, const ValueInCase& value_of);

}  // namespace pleuel
