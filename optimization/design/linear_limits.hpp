#pragma once

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// @throws InputError  naming the linear limits of a file that contradict each other or the bounds of its
///                     variables (linear_conflict.hpp)
void require_linear_limits(const ProblemFile& file);

}  // namespace pleuel
