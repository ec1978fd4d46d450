#pragma once

#include <string>

#include "core/response/response.hpp"

namespace pleuel {

/// When and where the two peaks of a tie are: "at 0.08 s (node 0) and at 0.05 s (node 3)".
/// @param response  with a history
std::string describe_tie(const PeakTie& tie, const Response& response);

}  // namespace pleuel
