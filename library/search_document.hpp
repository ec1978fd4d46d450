#pragma once

#include <string>

#include "cli/text/json.hpp"
#include "core/scene/problem_file.hpp"
#include "include/pleuel.h"
#include "library/open_problem.hpp"
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
/// @throws InputError  "options: /tolerance must be greater than 0 and less than 1, got 3"
SearchOptions read_search_options(const std::string& text, const ProblemFile& problem);

/// Who hears of evaluations: a function of the caller, if there is one.
struct Listener {
  pleuel_observer observer = nullptr;
  void* user = nullptr;
};

/// Searches for the optimum of a problem; while it lasts, the listener hears of each evaluation and may end it.
/// @param start  the first design [SI]
/// @returns      the document of `optimize`, without what takes simulations of the optimum
/// @throws CallError if the listener threw; as search_design()
Json search_document(const ProblemFile& problem, const Eigen::VectorXd& start,
                     const SearchOptions& options, const Listener& listener);

}  // namespace pleuel
