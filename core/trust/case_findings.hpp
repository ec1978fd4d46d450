#pragma once

#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/trust/finding.hpp"

namespace pleuel {

/// Findings of several load cases, one list a case, as one list, ranked (ranking.hpp).
std::vector<Finding> joined_findings(const ProblemFile& problem,
                                     const std::vector<std::vector<Finding>>& of_cases);

}  // namespace pleuel
