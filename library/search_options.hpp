#pragma once

#include <string>

#include "core/scene/problem_file.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

/// How a problem is optimized from outside.
struct SearchOptions {
  SolveOptions solve;
  int starts = 1;
  int jobs = 1;
};

/// Those of the problem, with what a JSON object has in their place: "backend", "tolerance", "max_iterations",
/// "starts", "jobs", "checks".
/// @throws InputError  "options: /tolerance must be a number between 0 and 1, got 3"
SearchOptions read_search_options(const std::string& text, const ProblemFile& problem);

}  // namespace pleuel
