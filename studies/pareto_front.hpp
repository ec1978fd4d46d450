#pragma once

#include <optional>
#include <vector>

#include "studies/front_gaps.hpp"
#include "studies/pareto_point.hpp"

namespace pleuel {

/// Of sizes from lists, where all choices were simulated.
struct ChoiceCounts {
  int all = 0, failed = 0;  ///< failed: could not be simulated
  int feasible = 0;         ///< keep the limits other than the one that is varied
};

struct ParetoFront {
  std::vector<ParetoPoint> points;  ///< in the order of limits
  FrontGaps gaps;                   ///< of a front that was asked for a gap
  std::optional<ChoiceCounts> choices;
  bool is_whole = true;  ///< no stop was asked for before its end
};

}  // namespace pleuel
