#include "core/scene/number_range.hpp"

#include <cmath>

namespace pleuel {

bool is_within(Range range, double value) {
  if (!std::isfinite(value)) return false;
  switch (range) {
    case Range::any:
      return true;
    case Range::positive:
      return value > 0.0;
    case Range::not_negative:
      return value >= 0.0;
    case Range::poisson:
      return value > -1.0 && value < 0.5;
    case Range::fraction:
      return value >= 0.0 && value <= 1.0;
    case Range::below_one:
      return value >= 0.0 && value < 1.0;
  }
  return false;
}

}  // namespace pleuel
