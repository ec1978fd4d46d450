#pragma once

#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// A sentence for each variable with equal bounds whose derivatives are not those of the mechanism:
/// it would move a place along an elastic beam (core/scene/scene_rules.hpp).
std::vector<std::string> unknown_derivatives(const ProblemFile& problem, const Design<double>& x);

}  // namespace pleuel
