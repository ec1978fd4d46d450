#pragma once

#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Whether the history of a response is nothing but round-off, one a response: below a tiny share
/// of what its kind is made of, as the axial stress in pure bending beside the von Mises stress,
/// the force of a joint across a force, or the torque of a drive that nothing resists beside that
/// force times the size of the mechanism. So is a section force or stress at a place where it vanishes
/// beside that elsewhere in the beam, though elements leave more of it. Constants never are.
std::vector<bool> find_round_off(const TrustedRun& run);

}  // namespace pleuel
