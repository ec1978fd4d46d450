#pragma once

#include <memory>

namespace pleuel {

class PeriodMap;

/// How the start of a motion that repeats itself was found.
struct PeriodicStart {
  double period = 0.0;  ///< [s]
  int steps = 0;        ///< of the trajectory that make the first period
  /// For the derivatives of the start; of this motion or of one close by.
  std::shared_ptr<const PeriodMap> map;
  int simulations = 0;       ///< of a period
  int differentiations = 0;  ///< of a period, for the map
  double gap = 0.0;  ///< that is left after a period: of each coordinate relative to its scale
  /// By what a disturbance grows in a period, in the long run (PeriodMap::growth).
  double growth = 0.0;
};

}  // namespace pleuel
