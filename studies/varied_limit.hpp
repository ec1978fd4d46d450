#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"
#include "studies/pareto_point.hpp"

/// The limit that a front varies (ParetoSettings::constraint).
namespace pleuel {

/// Of a limit that holds in several load cases all its constraints, else one.
/// @throws InputError if there is none
std::vector<std::size_t> varied_rows(const ProblemFile& problem);

/// Which of its values are good.
GoodSide good_side(const ProblemFile& problem);

/// @param limit  [SI]
void set_limit(ProblemFile& problem, double limit);

/// The value that is the nearest to the limit, or the furthest beyond [SI].
double limited_value(const ProblemFile& problem, const Eigen::VectorXd& constraints);

/// Of all constraints of the limit together, which moves in all of them.
double multiplier_of_limit(const ProblemFile& problem, const Eigen::VectorXd& multipliers);

}  // namespace pleuel
