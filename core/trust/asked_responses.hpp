#pragma once

#include <vector>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// Indices of the responses whose accuracy is asked for: those that are minimized or limited, or
/// listed in the block `accuracy`; of a file that does nothing of this, all.
std::vector<std::size_t> asked_responses(const ProblemFile& problem);

/// Those of them that are no expressions, and what their expressions are made from, each once.
std::vector<std::size_t> asked_parts(const ProblemFile& problem);

}  // namespace pleuel
