#pragma once

#include <string>

#include "core/model/model.hpp"
#include "core/response/response.hpp"
#include "core/scene/mode_choice.hpp"
#include "core/start/initial_state.hpp"

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

/// The state about which a mechanism vibrates.
struct VibrationState {
  InitialState initial;
  /// Why members are undeformed there, and not in equilibrium; empty if they are.
  std::string without_equilibrium;
};

/// Members in elastic equilibrium with the motion and what acts just before t = 0, however the
/// motion itself begins: about another state coefficients are not those of small vibrations, and
/// depend on the mesh. Equilibria that are not stable count, too; if there is none, members are
/// undeformed.
/// @throws SimulationError if the mechanism cannot be started at all
VibrationState vibration_state(Mechanism& mechanism);

}  // namespace pleuel
