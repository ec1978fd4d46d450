#pragma once

#include "core/integration/state_columns.hpp"
#include "core/model/model.hpp"
#include "core/scene/mode_choice.hpp"

namespace pleuel {

/// Derivatives of the natural angular frequency of a whole mechanism, or of the damping ratio or
/// growth rate of a mode, one a design variable. With right and left vectors of the linearized
/// equations at an eigenvalue s with Im s = ω, multipliers included,
///     P φ = 0, ψᴴ P = 0,   P = [ s²M + sG + K  Φ_qᵀ ; Φ_q  0 ]   ⇒   s' = −ψᴴ P' φ / ψᴴ P_s φ
/// P' is the change of the matrices along the state (whose exact sensitivities are given) and by
/// the design itself. Both are second derivatives of R; they are taken as fourth-order differences
/// of exact first ones. Where frequencies coincide, the mean of their derivatives, as far as their modes
/// count.
/// @param choice  its axis is a global one
Eigen::VectorXd frequency_sensitivity(const Model& model, const State& state,
                                      const StateSensitivity& sensitivity,
                                      const ModeChoice& choice);

}  // namespace pleuel
