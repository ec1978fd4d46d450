#pragma once

#include "core/trust/doubts.hpp"

namespace pleuel {

/// Natural frequencies of the whole mechanism that do not say what they seem to: unstable modes,
/// the stress of members that start undeformed though they are loaded or turn, and modes out of the
/// plane that cannot be had.
std::vector<Doubt> doubt_frequencies(const TrustedRun& run);

}  // namespace pleuel
