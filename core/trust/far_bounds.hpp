#pragma once

#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/trust/finding.hpp"

namespace pleuel {

/// Variables whose range says nothing of how far they may go, since one bound is far from both the
/// start and the other bound: other starts, step lengths and scales of a search are taken from it.
std::vector<Finding> check_far_bounds(const ProblemFile& problem);

}  // namespace pleuel
