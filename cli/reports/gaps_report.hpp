#pragma once

#include <string>

#include "cli/text/json.hpp"
#include "core/scene/problem_file.hpp"
#include "studies/pareto_front.hpp"

namespace pleuel {

/// Sentences on the gaps of a front that was asked for one: how large they are, where it jumps, and
/// what kept it from closing others. Empty of other fronts.
/// @param limited  name of what is limited
std::string gaps_message(const ProblemFile& problem, const ParetoFront& front,
                         const std::string& limited);

/// `largest` is null of fewer than two points.
/// {"asked", "largest", "left": [{"points": [i, j], "limited": [a, b], "size", "cause"}]}; null of
/// other fronts. Points are counted from 1.
Json gaps_document(const ProblemFile& problem, const ParetoFront& front);

}  // namespace pleuel
