#pragma once

#include <vector>

#include "core/integration/mechanism.hpp"

namespace pleuel {

/// Constraints that follow from the others wherever the mechanism can go, as in a planar loop of
/// spatial revolutes. Candidates are the rows of Φ_q that a rank-revealing QR factorisation with
/// column pivoting leaves over at the guess; they are redundant if they still hold after a small
/// motion in which only the others are kept. So a position in which the mechanism is merely
/// singular is told from redundancy. The guess has to meet the constraints.
/// @returns indices of multipliers, ascending
std::vector<int> redundant_constraints(Mechanism& mechanism);

}  // namespace pleuel
