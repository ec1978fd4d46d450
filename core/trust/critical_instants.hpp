#pragma once

#include <set>

#include "core/response/analysis.hpp"

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

}  // namespace pleuel
