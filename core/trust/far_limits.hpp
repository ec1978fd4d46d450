#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// What is said of a value [SI] that is so far beyond the limit of a response; nothing if it is not.
std::optional<std::string> far_limit_text(const ProblemFile& problem,
                                          const ConstraintSettings& constraint, double value);

/// Limits that the value exceeds (or, of lower ones, misses) more than ten-thousandfold: a plain
/// number is in SI units, so that a stress limit of 80 is 80 Pa.
std::vector<Finding> check_far_limits(const TrustedRun& run);

}  // namespace pleuel
