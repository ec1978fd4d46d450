#pragma once

#include "cli/text/json.hpp"
#include "include/pleuel.h"
#include "library/open_problem.hpp"
#include "library/search_options.hpp"

namespace pleuel {

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
