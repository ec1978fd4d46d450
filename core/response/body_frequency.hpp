#pragma once

#include "core/model/model.hpp"
#include "core/response/response.hpp"

namespace pleuel {

/// Natural angular frequencies [rad/s] of an elastic body held in its frame, undamped:
///     K φ = ω² S_ff φ,    ω' = φᵀ (K' − ω² S_ff') φ / 2ω   with  φᵀ S_ff φ = 1
/// in its elastic coordinates: a tangent frame clamps the first node, a chord frame pins both ends,
/// a mean-axis frame leaves the body free. Where frequencies coincide, the mean of their
/// derivatives: for bending of sections with equal inertia they are the same.
/// @param mode       from 0, the lowest
/// @param variables  number of design variables
/// @throws InputError if the body has no such mode
DesignConstant body_frequency(const BodyModel& body, int mode, int variables);

}  // namespace pleuel
