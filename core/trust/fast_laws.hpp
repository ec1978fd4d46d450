#pragma once

#include "core/trust/doubts.hpp"

namespace pleuel {

/// Loads and drives that change faster than the steps can follow: what acts between two instants is
/// not seen, however well energy is balanced. And drives whose speed jumps.
std::vector<Doubt> doubt_fast_laws(const TrustedRun& run);

}  // namespace pleuel
