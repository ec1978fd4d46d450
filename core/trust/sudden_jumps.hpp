#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/integration/trajectory.hpp"
#include "core/response/analysis.hpp"

namespace pleuel {

/// A jump of what acts on a mechanism: of loads, of accelerations of drives.
struct SuddenJump {
  int step;                ///< the instant
  State before;            ///< of the instant before, of a start at it
  State behind;            ///< positions and velocities at it, and the time shortly behind it
  Eigen::VectorXd change;  ///< of the residual, constraints on acceleration level, n + m
};

/// Those of a simulation, in their order: at the start, where loads and speeds are there at once
/// (of a motion that repeats itself between its end and its beginning), and at the instants where
/// something that acts is not smooth.
std::vector<SuddenJump> sudden_jumps(const Analysis& analysis);

/// All of them if they are few, or those that change most in each window of steps: of each force
/// that jumps some.
std::vector<SuddenJump> different_jumps(std::vector<SuddenJump> jumps,
                                        const std::vector<StepRange>& windows);

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
