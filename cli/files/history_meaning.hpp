#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/shown_unit.hpp"

/// What a history is beside the number that is made from it.
namespace pleuel {

/// The unit of the history of a response: that of the number, but for an integral over time.
inline ShownUnit history_unit(const ResponseSettings& response) {
  if (response.over_time != OverTime::integral) return unit_of(response);
  ResponseSettings instant = response;
  instant.over_time = OverTime::max;
  instant.unit.clear();
  return unit_of(instant);
}

/// Whether a limit on the number is one on each instant of its history: so of peaks, but not of what
/// cycles of stress, a mean or an integral make of the history.
inline bool limits_each_instant(const ResponseSettings& response) {
  const bool is_of_cycles =
      response.type == ResponseType::fatigue || response.type == ResponseType::fatigue_damage;
  const bool is_peak = response.over_time == OverTime::max || response.over_time == OverTime::min ||
                       response.over_time == OverTime::max_abs;
  return is_peak && !is_of_cycles;
}

}  // namespace pleuel
