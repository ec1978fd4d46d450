#pragma once

#include <array>
#include <vector>

#include "studies/point_searches.hpp"

namespace pleuel {

/// The ends of a front between two responses: the best design for each of them.
struct FrontEnds {
  std::vector<FoundPoint> points;
  std::array<GoalScale, 2> scales;  ///< of both responses between the ends
};

/// The best designs for both responses (ParetoSettings::goals), and of equally good ones the best for
/// the other. Each search is a task of its own.
/// @param problem  that of trade_off_problem()
/// @returns two, whatever became of their searches
FrontEnds find_front_ends(const ProblemFile& problem, const SolveOptions& options,
                          const Execution& execution);

}  // namespace pleuel
