#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/solve.hpp"
#include "studies/front_scale.hpp"
#include "studies/sized_search.hpp"

/// The ends of a front between two responses.
namespace pleuel {

/// The best design for one of two responses.
struct FrontEnd {
  Result result;
  std::array<double, 2> values{};  ///< of both responses
  std::optional<TriedSizes> sizes = {};
  double start_value = 0.0;  ///< of the response that it is best for, where the search began
};

/// One of the responses between both ends. Where it is 0 at both, round-off of what it was at the
/// start is its accuracy.
GoalScale end_scale(const std::vector<FrontEnd>& ends, std::size_t goal);

/// The best designs for both responses (ParetoSettings::goals), and of equally good ones the best for
/// the other. Each search is a task of its own.
/// @param file  that of the user: without the limit that is varied
/// @returns two, whatever became of their searches
std::vector<FrontEnd> find_front_ends(const ProblemFile& file, const SolveOptions& options,
                                      const Execution& execution);

/// Sets starts, within the bounds exactly: an optimum may miss them by rounding.
void start_from(const Eigen::VectorXd& x, std::vector<DesignVariable>& variables);

/// The searches, made again on another rank (PackedWork).
inline constexpr const char* end_work_name = "ends";
std::unique_ptr<TaskWork> make_end_work(const std::string& content);

}  // namespace pleuel
