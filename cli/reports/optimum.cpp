#include "cli/reports/optimum.hpp"

#include <algorithm>
#include <cmath>

namespace pleuel {

namespace {

/// The range says little where one bound is far away.
bool is_at(double bound, const DesignVariable& variable, double value) {
  const double range = variable.upper - variable.lower;
  const double size = std::abs(bound) + std::abs(variable.start);
  return std::abs(value - bound) <= 1e-6 * (size > 0.0 ? std::min(range, size) : range);
}

}  // namespace

UsedLimit used_limit(const ConstraintSettings& constraint, double value) {
  UsedLimit used;
  const bool has_both = constraint.lower && constraint.upper;
  used.is_upper = has_both ? *constraint.upper - value <= value - *constraint.lower
                           : constraint.upper.has_value();
  used.limit = used.is_upper ? *constraint.upper : *constraint.lower;
  if (used.limit > 0.0 && value >= 0.0 && used.is_upper) used.utilisation = value / used.limit;
  if (used.limit > 0.0 && value > 0.0 && !used.is_upper) used.utilisation = used.limit / value;
  return used;
}

bool is_at_lower_bound(const DesignVariable& variable, double value) {
  return is_at(variable.lower, variable, value);
}

bool is_at_upper_bound(const DesignVariable& variable, double value) {
  return is_at(variable.upper, variable, value);
}

}  // namespace pleuel
