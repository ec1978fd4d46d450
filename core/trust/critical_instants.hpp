#pragma once

#include <set>

#include "core/response/analysis.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Instants at which it is worth while to ask whether the members of a mechanism are stable: where each elastic
/// beam is pressed most, and all of them together, and of the fastest turn.
struct CriticalInstants {
  std::set<int> all;
  /// By what presses alone: whether a beam is pressed beyond a twentieth of the Euler load of a column as
  /// long as all beams together, or at all beside springs.
  bool may_buckle = false;
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

/// Whether nothing may grow in space at these instants of a motion in the plane, which is one in space.
bool is_firm_in_space(const ProblemFile& space, const TrustedRun& run,
                      const std::set<int>& instants);

}  // namespace pleuel
