#pragma once

#include "core/integration/time_loop.hpp"

namespace pleuel {

/// How many checkpoints and states there may be at once. Two levels (Griewank 1992): with K
/// checkpoints, the stretches between of L states each, one of which is held at a time, a
/// trajectory of K L states is gone through at the cost of one more simulation. Half of the memory
/// is for the checkpoints, half for the states.
struct CheckpointPlan {
  double state_bytes = 0.0, checkpoint_bytes = 0.0;
  double memory = 0.0;

  bool holds(double states) const { return states * state_bytes <= memory; }
  int most_checkpoints() const;  ///< K
  int longest_stretch() const;   ///< L
  /// K L, not beyond the range of int.
  int most_states() const;
  /// The states between two checkpoints, for so many in total: as few as will do.
  int stretch_for(int states) const;
  /// The memory that holds so many states, at least [byte].
  double least_memory(int states) const;
};

/// A simulation that keeps checkpoints only. Where the number of steps is not
/// known beforehand, every second one is given up whenever there are too many.
/// @throws InputError if the memory does not even hold enough checkpoints of equal steps
/// @throws SimulationError as simulate(), or where the checkpoints turn out not to fit
Trajectory simulate_with_checkpoints(TimeLoop loop, const CheckpointPlan& plan);

}  // namespace pleuel
