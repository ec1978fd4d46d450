#pragma once

#include "core/model/model.hpp"
#include "core/response/response.hpp"
#include "core/scene/mode_choice.hpp"

namespace pleuel {

/// A frequency of a body held in its frame, with those of its modes that count.
struct BodyMode {
  double square;            ///< ω² [rad²/s²]
  Eigen::MatrixXcd shapes;  ///< φ in elastic coordinates, n × k, φᴴ S_ff φ = 1
};

/// @throws InputError if the body has no such mode
BodyMode body_mode(const BodyModel& body, const ModeChoice& choice);

/// Natural angular frequencies [rad/s] of an elastic body held in its frame, undamped:
///     K φ = ω² S_ff φ,    ω' = φᵀ (K' − ω² S_ff') φ / 2ω   with  φᵀ S_ff φ = 1
/// in its elastic coordinates: a tangent frame clamps the first node, a chord frame pins both ends,
/// a mean-axis frame leaves the body free. Where frequencies coincide, the mean of their
/// derivatives, as far as their modes count: for bending of sections with equal inertia they are
/// the same.
/// @param choice     its axis is one of the body
/// @param variables  number of design variables
/// @throws InputError if the body has no such mode
DesignConstant body_frequency(const BodyModel& body, const ModeChoice& choice, int variables);

}  // namespace pleuel
