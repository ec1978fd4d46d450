#pragma once

#include "core/integration/checkpoint_plan.hpp"
#include "core/integration/time_loop.hpp"

namespace pleuel {

/// A simulation that keeps checkpoints only (checkpoint_plan.hpp). Where the number of steps is not
/// known beforehand, every second one is given up whenever there are too many.
/// @throws InputError if the memory does not even hold enough checkpoints of equal steps
/// @throws SimulationError as simulate(), or where the checkpoints turn out not to fit
Trajectory simulate_with_checkpoints(TimeLoop loop, const CheckpointPlan& plan);

}  // namespace pleuel
