#pragma once

#include "core/trust/doubt.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Axial section forces of bent beams. Section forces are in axes of the body frame; a section that
/// is turned by θ takes V θ of the shear force V into its own axial force, which may be all there
/// is.
std::vector<Doubt> doubt_turned_sections(const TrustedRun& run);

}  // namespace pleuel
