#include "cli/reports/optimum.hpp"

namespace pleuel {

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

}  // namespace pleuel
