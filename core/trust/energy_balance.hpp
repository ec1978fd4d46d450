#pragma once

#include "core/trust/doubts.hpp"

namespace pleuel {

/// Energy that comes from nowhere: steps too long for what moves, or a drive that jumps.
std::vector<Doubt> doubt_energy_balance(const TrustedRun& run);

}  // namespace pleuel
