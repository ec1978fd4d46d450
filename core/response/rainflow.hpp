#pragma once

#include <cstddef>
#include <vector>

namespace pleuel {

/// A cycle, or half of one, between two turning points of a history.
struct CountedCycle {
  std::size_t from, to;  ///< indices of turning points
  double count;          ///< 1 or ½
};

/// Rainflow counting of ASTM E1049-85 (2017), 5.4.4, in the order in which cycles close.
/// @param turning  maxima and minima in turn, the first and the last value among them
std::vector<CountedCycle> count_rainflow(const std::vector<double>& turning);

}  // namespace pleuel
