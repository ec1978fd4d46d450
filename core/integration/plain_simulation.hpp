#pragma once

#include "core/integration/scheme.hpp"
#include "core/integration/simulation_options.hpp"
#include "core/integration/trajectory.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// A simulation from consistent initial values, or from a given state: see simulate(). The period
/// of the options says nothing here.
/// @param start  what to set out from, as if a step had led there; null: consistent initial values
Trajectory simulate_plainly(Mechanism& mechanism, const SimulationOptions& options,
                            const InstantObserver& observer, const SchemeState* start = nullptr);

}  // namespace pleuel
