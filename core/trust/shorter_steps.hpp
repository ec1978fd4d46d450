#pragma once

#include <vector>

#include "core/integration/trajectory.hpp"

namespace pleuel {

/// Short steps from an instant of a trajectory on, where something jumps.
struct ShorterSteps {
  double begin, end;  ///< [s]
  double step;        ///< [s]
};

/// The instants of a trajectory, and more of them: steps are short between begin and end, and grow
/// behind it, slowly enough for the scheme to go on as it is. One short step goes before each begin
/// (of that of a motion that repeats itself at the end of its period), since a step knows the force
/// at its end: a long one would take up half of the jump.
std::vector<double> instants_with(const Trajectory& trajectory,
                                  const std::vector<ShorterSteps>& stretches);

}  // namespace pleuel
