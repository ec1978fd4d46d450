#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "optimization/broken_limits.hpp"
#include "optimization/problem.hpp"

/// Phase 1 of a search: the limits alone count, whatever the objective says.
namespace pleuel {

/// The constraint that each component of a problem with more of them stands for; none of components that stand
/// for something else.
using ConstraintOfRow = std::vector<std::optional<std::size_t>>;

/// Of a problem whose components are its constraints.
ConstraintOfRow own_constraints(const Problem& problem);

/// The worst component of each constraint: a value for each.
Eigen::VectorXd worst_values(const ConstraintOfRow& constraint_of_row, const Eigen::VectorXd& rows,
                             const std::vector<Constraint>& limits);

/// The limits of a problem as components that are smooth in the design: a limit may have several, such as the
/// peaks of parts of it. The variables are those of the problem.
struct LimitRows {
  Problem* problem = nullptr;
  ConstraintOfRow constraint_of_row;
};

/// The first design with gradients among those on the way from the start to the middle of the bounds
/// and, after them, others spread between the bounds.
std::optional<Eigen::VectorXd> evaluable_design(Problem& problem);

/// A design within the limits, restored from `best` (restoration.hpp) or, where that fails, from
/// those of designs spread between the bounds that break the limits least.
/// @param magnitudes   of the constraints of `limits`, see scaling.hpp
std::optional<Eigen::VectorXd> design_within_limits(const LimitRows& rows, const Problem& limits,
                                                    const Eigen::VectorXd& magnitudes,
                                                    const Eigen::VectorXd& best);

/// Minimizes the largest relative violation of all limits from a design on, by gradients; and where
/// that is not 0, for each limit in the conflict (six at most) what it would have to be if all
/// others were kept. Each is an optimization of its own (phase_one_problem.hpp), a local one.
/// @param start  can be evaluated, with gradients
LeastViolation find_least_violation(const LimitRows& rows, const std::vector<Constraint>& limits,
                                    const Eigen::VectorXd& start, int iterations);

}  // namespace pleuel
