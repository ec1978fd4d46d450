#pragma once

#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/trust/doubt.hpp"

namespace pleuel {

/// Doubts of several load cases, one list a case, as one list, ranked (ranking.hpp).
std::vector<Doubt> joined_doubts(const ProblemFile& problem,
                                 const std::vector<std::vector<Doubt>>& of_cases);

}  // namespace pleuel
