#pragma once

#include <string>

/// Whether small disturbances of a mechanism grow along its motion.
namespace pleuel {

struct Mechanism;
struct Trajectory;

/// How a small disturbance of a mechanism grows along its motion.
struct DisturbanceGrowth {
  double factor = 0.0;                ///< by which it is larger than where it began
  double begin = 0.0, largest = 0.0;  ///< when it began, and when it is largest [s]
  std::string where;                  ///< what it deforms most then: "the body \"rod\""
};

/// The largest growth of several disturbances: of the lowest modes of deformation at an instant, and
/// of those that the loads soften most. They begin without velocity and are propagated by the exact
/// tangents of the steps (StepDifferentiation), so that whatever feeds them is seen: loads beyond
/// buckling as long as they last, forces that follow, damping that turns, coefficients that change with the time
/// or the angle. Those that have not grown begin anew several times in the motion.
///
/// The size of a disturbance is the root of its elastic energy, of springs, too: a vibration keeps it.
/// One that mostly turns or moves bodies counts where springs hold them and the motion goes elsewhere; else it
/// is a pendulum that falls. What it grows beyond 1e6 is not followed. Of members, unless only that of what springs
/// hold does harm (harmful_growth).
DisturbanceGrowth disturbance_growth(const Mechanism& mechanism, const Trajectory& trajectory);

}  // namespace pleuel
