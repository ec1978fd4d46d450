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

/// Whether the goals can be exchanged: between two responses, or of one problem without load cases
/// whose limit is on a response, not on a sum of variables, and is kept free of no deviations.
bool can_exchange_goals(const ProblemFile& problem);

/// The problem that improves what is limited, with a limit on the objective.
/// @param objective_limit  [SI], of what is maximized the negative
ProblemFile with_exchanged_goals(ProblemFile problem, double objective_limit);

}  // namespace pleuel
