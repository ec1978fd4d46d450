#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "optimization/elastic_problem.hpp"

namespace pleuel {

/// The limits of a problem as rows that are smooth in the design: a limit may have several rows,
/// such as the peaks of parts of it. The variables are those of the problem.
struct LimitRows {
  Problem* problem = nullptr;
  std::vector<std::size_t> constraint_of_row;

  /// The worst row of each constraint.
  Eigen::VectorXd fold(const Eigen::VectorXd& rows, const std::vector<Constraint>& limits) const;
};

/// A limit that is broken where limits are broken least, and what it would have to be [SI].
struct ExceededLimit {
  std::size_t constraint = 0;
  bool is_upper = true;
  double limit = 0.0;
  /// It is in conflict with the others that are: its multiplier holds the design where it is.
  bool is_in_conflict = false;
  /// That would do if all others are kept; none: they are in conflict without it, too, or nothing
  /// was found.
  std::optional<double> alone;
  double together = 0.0;  ///< that of the design: what would do if all broken limits give
};

/// The design that breaks its limits least, as far as could be found from one design.
struct LeastViolation {
  Eigen::VectorXd x;
  double violation = 0.0;             ///< the largest, relative to the magnitudes of the limits
  std::vector<ExceededLimit> limits;  ///< those in conflict first
  /// That no design nearby breaks its limits less is verified as any optimum is.
  bool is_proven = false;
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
