#pragma once

#include <string>
#include <vector>

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// A mechanism of more coordinates is not judged: its stiffness would have to be a dense matrix.
constexpr int most_judged_coordinates = 600;

/// Straight members in space that buckle without a trace in the motion: the stiffness of the whole
/// mechanism with its loads, rigid parts and inertia forces (elastic_stability.hpp), at the
/// instants at which beams with geometric stiffening are pressed most, and where all that turns does
/// so alike, as shafts with disks, when that is fastest. Serious. Nothing is looked for below a
/// twentieth of the Euler load of two pins, nor in mechanisms of more than most_judged_coordinates.
std::vector<Doubt> doubt_unstable_members(const TrustedRun& run);

/// The same of a mechanism that was simulated in space.
/// @param unseen  a sentence: why the motion does not show it
std::vector<Doubt> doubt_instability(const Scene& scene, const Analysis& analysis,
                                     const std::string& unseen);

}  // namespace pleuel
