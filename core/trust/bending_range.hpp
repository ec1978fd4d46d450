#pragma once

#include "core/trust/doubts.hpp"

namespace pleuel {

/// Beams that bend beyond what linear elasticity in a body frame is good for.
std::vector<Doubt> doubt_bending_range(const TrustedRun& run);

}  // namespace pleuel
