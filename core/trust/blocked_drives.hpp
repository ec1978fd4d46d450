#pragma once

#include <string>
#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Drives that no rigid motion follows, since joints or other drives hold already what they move:
/// all that moves then does so because bodies bend. That may be meant, of a press fit say; mostly a
/// joint has a freedom too few, or a drive is too many.
std::vector<Finding> check_blocked_drives(const TrustedRun& run);

/// Drives that stand still where nothing else acts: numbers that are round-off.
std::vector<Finding> check_rest(const TrustedRun& run);

/// The finding at a state; empty if there is none.
std::string blocked_drives_text(const Model& model, const State& state);

}  // namespace pleuel
