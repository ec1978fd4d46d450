#pragma once

#include <vector>

#include "core/response/analysis.hpp"

namespace pleuel {

/// The steps of a simulation at which a moving picture is drawn: equal in time, so close that no
/// body turns by more than some degrees from one to the next, and those at which responses have
/// their peaks.
/// @param most  at most so many, besides the peaks
std::vector<int> frames_of_motion(const Analysis& analysis, int most);

}  // namespace pleuel
