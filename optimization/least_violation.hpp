#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "optimization/elastic_problem.hpp"
#include "optimization/limit_conflict.hpp"

namespace pleuel {

/// The limits of a problem as rows that are smooth in the design: a limit may have several rows,
/// such as the peaks of parts of it. The variables are those of the problem.
struct LimitRows {
  Problem* problem = nullptr;
  std::vector<std::size_t> constraint_of_row;

  /// The worst row of each constraint.
  Eigen::VectorXd fold(const Eigen::VectorXd& rows, const std::vector<Constraint>& limits) const;
};

/// Minimizes the largest relative violation of all limits from a design on, by gradients; and where
/// that is not 0, for each limit in the conflict (six at most) what it would have to be if all
/// others were kept. Each is an optimization of its own (elastic_problem.hpp), a local one.
/// @param start  can be evaluated, with gradients
LeastViolation find_least_violation(const LimitRows& rows, const std::vector<Constraint>& limits,
                                    const Eigen::VectorXd& start, int iterations);

/// "stress ≤ 60 MPa and bow ≤ 0.05 mm are in conflict … Any of these changes resolves it: …"
std::string describe(const LeastViolation& least, const Problem& problem);

}  // namespace pleuel
