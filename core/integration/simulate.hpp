#pragma once

#include "core/integration/simulation_options.hpp"
#include "core/integration/trajectory.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// Integrates M a − Q + Φ_qᵀ λ = 0 with the constraints in the form that is asked for
/// (step_equations.hpp; for index 3 Arnold & Brüls 2007). Each step is solved by Newton's method
/// with the exact tangent of the beginning of the step (renewed where it converges slowly). A step
/// in which it fails is halved, up to six times. Nothing is allocated in the time loop but by the
/// observer, and for instants that are more than the regular ones. With a projection each step of
/// index 1 ends with it (projection.hpp). With a period, it starts from the motion that repeats
/// itself.
/// @throws InputError if the memory does not even hold enough checkpoints of equal steps
/// @throws SimulationError saying time, step, iteration, equation and what to try; or that the
///         local error is too large with the smallest step
Trajectory simulate(Mechanism& mechanism, const SimulationOptions& options,
                    const InstantObserver& observer = {});

}  // namespace pleuel
