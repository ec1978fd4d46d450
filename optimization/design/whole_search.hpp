#pragma once

#include <optional>
#include <vector>

#include "optimization/design/multi_start.hpp"
#include "optimization/design/size_choice.hpp"

namespace pleuel {

/// What a search came to.
struct WholeSearch {
  MultiStart all;
  std::optional<SizeChoiceReport> sizes;  ///< where some are chosen from lists
};

/// All that an optimization of a problem file does: solve_from_starts(), then choose_sizes() where sizes are
/// chosen from lists. A request to stop ends it with the best design so far, of which nothing is proven
/// (`interrupted`).
/// @throws Stopped before the first design was simulated; and as solve_from_starts()
WholeSearch search_design(const ProblemFile& file, const std::vector<Eigen::VectorXd>& starts,
                          const SolveOptions& options, const Execution& execution,
                          const Observer& observer, const Notice& notice);

}  // namespace pleuel
