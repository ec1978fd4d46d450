#pragma once

#include <functional>

#include "core/integration/simulate.hpp"
#include "sensitivity/state_sensitivity.hpp"

namespace pleuel {

/// Sees each step of direct differentiation, beginning with step 0.
using SensitivityObserver =
    std::function<void(int step, const State& state, const StateSensitivity& sensitivity)>;

/// Direct differentiation of the discrete scheme: exact for the steps that were taken, not for the
/// differential equation behind them. With the predicted part ŝ = history · s of the differentiated
/// scheme, at the converged state of each step
///     [ s(β'M + γ'C + K)  Φ_qᵀ ; Φ_q  0 ] [s_q; s s_λ]⁺ = −[ s (R_x + M ŝ_a + C ŝ_v); Φ_x ]
/// One factorisation a step, all design variables as one block. Decoupled from the finite-element
/// model: R_x comes from the invariants' derivatives (Gufler, Wehrle & Vidoni 2022).
/// @param trajectory  of simulate() for the same mechanism
/// @throws SimulationError if a step matrix is singular
void differentiate(Mechanism& mechanism, const Trajectory& trajectory,
                   const SensitivityObserver& observer);

}  // namespace pleuel
