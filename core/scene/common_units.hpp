#pragma once

#include <span>
#include <string_view>

#include "core/scene/dimension.hpp"

namespace pleuel {

/// What one unit is in SI units: {"mm", "m", 1e-3}.
struct CommonUnit {
  std::string_view unit, si;
  double scale;
  Dimension dimension = {};  ///< of an SI unit
};

/// Units that most files have. Their conversions need no database, which takes some milliseconds to
/// read; they are what the database says, to the last bit.
std::span<const CommonUnit> common_units();

/// Null if it is none of them.
const CommonUnit* find_common_unit(std::string_view unit);

}  // namespace pleuel
