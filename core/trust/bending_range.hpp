#pragma once

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Bodies whose deformation is too large for linear elasticity in a body frame, by the estimated
/// error of their displacements, rotations and stresses (geometric_error.hpp).
std::vector<Doubt> doubt_bending_range(const TrustedRun& run);

}  // namespace pleuel
