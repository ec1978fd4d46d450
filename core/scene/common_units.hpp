#pragma once

#include <optional>
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

std::optional<double> find_common_scale(std::string_view unit, std::string_view si);

/// What a common unit measures.
std::optional<MeasuredUnit> find_common_measure(std::string_view unit);

}  // namespace pleuel
