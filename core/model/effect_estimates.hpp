#pragma once

#include <map>
#include <string>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// Estimates, for each elastic beam (by its name), by how much (relative) responses would change
/// without each of its effects, at the start design. The mechanism is simulated with rigid beams (at
/// most 1000 steps); its inertia loads and joint forces deform the beams quasi-statically by q_s(t).
/// With the size L of the mechanism and its largest acceleration a,
///     elasticity             2 max( |q_s|/L, |q̈_s|/a )     2: sudden loads
///     axial elasticity       the same of the axial displacements
///     torsional elasticity   the same of the twist times half the depth of the section
///     geometric stiffening   max |N| / P,  P = π² EI/(kL)²
///                            k = 1 (chord, mean axis) or 2 (tangent)
///     rotary inertia         π² I/(A L²)
/// The elasticity of beams whose stress, deflection, frequency or buckling is asked for is never
/// left out (estimate: infinite), nor is twist where stress is asked for.
/// None without a tolerance. Where the rigid mechanism cannot be simulated (it may be
/// over-constrained) there are no estimates, and everything is built.
std::map<std::string, BeamEstimates> estimate_effects(const ProblemFile& problem);

}  // namespace pleuel
