#include "cli/reports/optimum.hpp"

namespace pleuel {

namespace {

double bound_tolerance(const DesignVariable& variable) {
  return 1e-6 * (variable.upper - variable.lower);
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
  return value - variable.lower <= bound_tolerance(variable);
}

bool is_at_upper_bound(const DesignVariable& variable, double value) {
  return variable.upper - value <= bound_tolerance(variable);
}

}  // namespace pleuel
