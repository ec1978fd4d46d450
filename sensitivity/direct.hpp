#pragma once

#include <functional>

#include "core/integration/simulate.hpp"
#include "core/integration/state_columns.hpp"

namespace pleuel {

/// Sees each step of direct differentiation, beginning with step 0.
using SensitivityObserver =
    std::function<void(int step, const State& state, const StateSensitivity& sensitivity)>;

/// Direct differentiation of the discrete scheme with respect to the design variables, from the
/// start on (initial_sensitivity.hpp), step by step
/// (core/integration/step_differentiation.hpp).
/// @param trajectory  of simulate() for the same mechanism
/// @throws SimulationError if a step matrix is singular
void differentiate(Mechanism& mechanism, const Trajectory& trajectory,
                   const SensitivityObserver& observer);

/// The same as far as a step only: what comes later costs nothing.
void differentiate_until(int last_step, Mechanism& mechanism, const Trajectory& trajectory,
                         const SensitivityObserver& observer);

}  // namespace pleuel
