#pragma once

#include <set>

#include "core/response/analysis.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// A disturbance that grows more makes another motion than the one that is shown.
constexpr double harmful_growth = 10.0;

/// Instants at which it is worth while to ask whether the members of a mechanism are stable: where each elastic
/// beam is pressed most, and all of them together, and of the fastest turn. With springs or bodies of meshes
/// also where joints bear most, and where springs and loads push most.
struct CriticalInstants {
  std::set<int> all;
  /// By what presses alone: whether a beam is pressed beyond a twentieth of the Euler load of a column as
  /// long as all beams together, or at all beside springs.
  bool may_buckle = false;
  /// The share of the loads that make the stiffness singular up to which no disturbance grows tenfold in
  /// this motion. Where inertia is the only load, its energy grows by what the stiffness gains:
  ///     Ė = ½ xᵀ K̇ x ≤ max(−ṡ, 0)/(1 − s) E,   s(t): the share that presses and turning take
  /// Elsewhere, and of rotors, whose coefficients may change otherwise, harmless_share.
  double harmless = 0.0;
};

CriticalInstants critical_instants(const Scene& scene, const Analysis& analysis);

// In which model of a mechanism members can buckle.

/// Whether the file says that something outside of the mechanism holds a body.
bool is_held(const Body& body);

/// Whether bodies move in space, beams have their geometric stiffening and elements enough, and nothing is
/// held from outside.
bool shows_buckling(const Scene& scene, const Model& model);

/// The mechanism in space, with geometric stiffening and with at least two elements a beam; what holds its
/// beams from outside holds them.
ProblemFile problem_in_space(const TrustedRun& run);

/// Whether nothing may grow in space at such instants of a motion in the plane, which is one in space.
bool is_firm_in_space(const ProblemFile& space, const TrustedRun& run,
                      const CriticalInstants& instants);

}  // namespace pleuel
