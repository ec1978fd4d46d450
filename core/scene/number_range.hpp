#pragma once

#include <string>

#include "core/scene/number.hpp"

namespace pleuel {

/// What a number must be beyond its physical quantity.
enum class Range {
  any,
  positive,
  not_negative,
  poisson,
  fraction,  ///< from 0 to 1
  below_one  ///< from 0 to less than 1
};

/// Whether the value is finite and keeps to the range.
bool is_within(Range range, double value);

/// A formula of design variables whose values are not free. The bounds of the variables do not say
/// what it can be: it has to be looked at for each design.
struct RangedFormula {
  Number number;
  Range range = Range::any;
  std::string place;  ///< "/scene/bodies/rod/section/width"
  std::string rule;   ///< "must be positive [m]"
};

}  // namespace pleuel
