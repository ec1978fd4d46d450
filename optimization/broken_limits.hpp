#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "optimization/problem.hpp"

/// Limits that a design breaks, and those that contradict each other.
namespace pleuel {

/// "rod_bow = 1.18 mm exceeds its upper limit 0.05 mm, …": all limits that are broken, the worst
/// first, each name once: rows of one name are peaks of one response. Empty if all are kept.
/// @param constraints  values c [SI]
/// @param scales       magnitudes C of the constraints
/// @param allowed      violation that does not count, relative to C
std::string broken_limits(const Problem& problem, const Eigen::VectorXd& constraints,
                          const Eigen::VectorXd& scales, double allowed);

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

/// "stress ≤ 60 MPa and bow ≤ 0.05 mm cannot be kept at once; … One change would do: …"; empty where no limit is
/// broken.
std::string describe(const LeastViolation& least, const Problem& problem);

}  // namespace pleuel
