#include "cli/reports/reached_bound.hpp"

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

ReachedBound reached_bound(const DesignVariable& variable, double value) {
  if (variable.lower == variable.upper) return ReachedBound::both;
  if (is_at(variable.lower, variable, value)) return ReachedBound::lower;
  return is_at(variable.upper, variable, value) ? ReachedBound::upper : ReachedBound::none;
}

const char* to_string(ReachedBound reached) {
  switch (reached) {
    case ReachedBound::lower:
      return "lower";
    case ReachedBound::upper:
      return "upper";
    case ReachedBound::both:
      return "both";
    default:
      return "";
  }
}

}  // namespace pleuel
