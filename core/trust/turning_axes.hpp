#pragma once

#include "core/model/model.hpp"

namespace pleuel {

/// Natural angular frequencies of a mechanism in space as mechanism_frequencies() has them, but
/// with displacements in axes that turn with the bodies, in place of axes that stand still. Where
/// the whole mechanism turns alike their coefficients are constant, and the frequencies exact. With
/// ω and α of a body in its axes A, small motions y of it are
///     δr = A y_r,  δω = ẏ_θ + ω × y_θ,
///     δr̈ = A (ÿ_r + 2 ω × ẏ_r + (ω̃ω̃ + α̃) y_r),  δα = ÿ_θ + ω × ẏ_θ + α × y_θ.
/// A point mass takes the axes of the body that turns fastest.
Eigen::VectorXd frequencies_in_turning_axes(const Model& model, const State& state);

}  // namespace pleuel
