#pragma once

#include <string>

#include "core/response/analysis.hpp"

namespace pleuel {

/// "Drive bearing: torque 464.28 → 199.13 N m (−57.1 %), power 92856 → 39826 W (−57.1 %)", a line
/// for each drive: the largest magnitudes over time of two designs. Empty without drives.
std::string drives_text(const ProblemFile& problem, const Analysis& start, const Analysis& optimum);

}  // namespace pleuel
