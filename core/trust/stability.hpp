#pragma once

#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// A mechanism of more coordinates is not judged: its stiffness would have to be a dense matrix.
constexpr int most_judged_coordinates = 600;

/// Whether members of a mechanism buckle or flutter, alone or together, where the motion does not
/// show it, as it is straight, in a plane, or too short. It is judged in space and with geometric
/// stiffening, for which a mechanism without them is simulated once more, with twice the steps.
///
/// At an equilibrium that the motion starts from the eigenvalues decide, rigid motions included. Along
/// a motion frozen eigenvalues only say whether to look: where the loads are more than a fifth of those that
/// make the stiffness singular (may_grow()), or more than what nothing grows tenfold below
/// (CriticalInstants::harmless), at the instants at which beams are pressed most, each of them and all
/// together, and of the fastest turn. Then small disturbances are propagated through all
/// of it (disturbance_growth.hpp). Serious where one grows more than tenfold; mentioned where an
/// instant is not stable, but does not last. Forces that follow, springs, rigid parts and turning
/// damping count as they are. Not seen is what moments do to a beam that they bend
/// (sideways_buckling.hpp).
///
/// A mechanism in a plane is judged in space where it may grow in the plane, or where a beam is pressed beyond
/// a twentieth of the Euler load of a column as long as all beams together, or at all beside springs.
/// Mechanisms of more than most_judged_coordinates are told of.
std::vector<Finding> check_stability(const TrustedRun& run);

}  // namespace pleuel
