#pragma once

#include <string>

#include "core/mechanism/mechanism.hpp"

/// Whether the members of a mechanism are in stable elastic equilibrium, and at what share of the
/// loads they buckle.
namespace pleuel {

struct ElasticStability {
  bool is_stable = true;
  int negative = 0;   ///< real negative eigenvalues of the stiffness
  std::string where;  ///< what moves most in the lowest mode: "the body \"rod\""; if unstable
  std::string how = "buckles";  ///< what it does, for people; if unstable
};

/// Counts the negative eigenvalues of the stiffness at a state. One is a deformation that grows.
/// Gyroscopic forces may hold an even number, and so may a stiffness that is not symmetric (loads
/// that follow); an odd one grows (Thomson & Tait). Whether they do is asked of the deformations of
/// these eigenvalues alone, with their mass.
/// A rotor whose stiffness changes with its angle, and that does not buckle standing still, counts as
/// stable: Floquet's theory would have to tell.
ElasticStability elastic_stability(const Mechanism& mechanism, const State& state);

/// Of the loads that make the stiffness singular: below this share nothing is looked for.
inline constexpr double harmless_share = 0.2;

/// Whether small disturbances of the members may grow: unless the stiffness, in axes that stand still and
/// in those that turn with the bodies, would stay positive if loads and motion took from it all the same
/// again, and again, up to 1/harmless times what they take. That leaves room for what frozen coefficients do
/// not show: forces that follow, damping that turns, coefficients that change.
bool may_grow(const Mechanism& mechanism, const State& state, double harmless = harmless_share);

/// The stiffness S R_q S of members and springs alone: undeformed, without loads, weight and motion.
Eigen::MatrixXd elastic_stiffness(const Mechanism& mechanism, const State& state);

/// The same position without deformation, motion and forces; weight is none, as all falls freely.
State without_forces(const Mechanism& mechanism, const State& loaded);

/// Whether all that turns does so alike and at a constant speed, but for small vibrations.
bool is_rotor(const Mechanism& mechanism, const State& state);

/// A state after a short time, as bodies do not deform.
State advanced(const Mechanism& mechanism, const State& state, double time);

/// A mechanism at a state.
struct MechanismState {
  const Mechanism& mechanism;
  const State& state;
};

/// By what factor the loads of a state buckle the members, from how they change the stiffness:
///     (K₀ + s (K₁ − K₀)) φ = 0,   the smallest s > 0; infinite if there is none
/// Not a number where springs hold motions as rigid bodies, which loads turn at once.
/// Linear buckling: K with the forces that the loads cause, without the coupling of bending with
/// stretching by deflection, which is of second order in both. Where all that deforms turns alike, it
/// is counted in axes that turn, and inertia forces grow with the loads.
/// @param unloaded  at a state without deformation, where accelerations and multipliers bear the
///                  loads, or without loads
/// @param loaded    in equilibrium with `share` of the loads, in the same coordinates
double buckling_load_factor(const MechanismState& unloaded, const MechanismState& loaded,
                            double share);

}  // namespace pleuel
