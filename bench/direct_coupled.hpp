#pragma once

#include "core/response/analysis.hpp"
#include "sensitivity/sampled_gradients.hpp"

namespace pleuel::bench {

/// Direct differentiation that is coupled with the finite-element model: in every step the
/// derivatives of the invariants of all beams are formed anew from their elements, instead of being
/// taken as the constants of the motion that they are. All else is shared with direct
/// differentiation. Only here to be compared with.
/// @param analysis  of beams without modes
/// @returns as sampled_gradients()
Eigen::MatrixXd direct_coupled_gradients(Analysis& analysis,
                                         const std::vector<SampledValue>& values);

}  // namespace pleuel::bench
