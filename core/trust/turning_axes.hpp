#pragma once

#include "core/model/model.hpp"

namespace pleuel {

/// Natural angular frequencies of a mechanism in space as mechanism_frequencies() has them, but
/// with displacements in axes that turn with the bodies, in place of axes that stand still. Where
/// the whole mechanism turns alike their coefficients are constant, and the frequencies exact
/// (core/start/turning.hpp).
Eigen::VectorXd frequencies_in_turning_axes(const Model& model, const State& state);

}  // namespace pleuel
