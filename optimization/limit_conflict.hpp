#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace pleuel {

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

}  // namespace pleuel
