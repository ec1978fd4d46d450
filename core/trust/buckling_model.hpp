#pragma once

#include <set>

#include "core/trust/trusted_run.hpp"

/// In which model of a mechanism members can buckle.
namespace pleuel {

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
