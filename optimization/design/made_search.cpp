#include "optimization/design/made_search.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"

namespace pleuel {

namespace {

/// Half the width of the region, in logarithms of the variables.
constexpr double first_radius = 0.7, largest_radius = 1.4, least_radius = 1e-3;
/// Errors of the stiffness that was foretold, below which the region grows, above which it shrinks.
constexpr double good_error = 0.2, bad_error = 0.5;
/// A step is no longer than so many times the one before: what was foretold of a short one tells little of a
/// long one.
constexpr double longest_next_step = 4.0;
/// A design that moves by less stays.
constexpr double small_step = 1e-3;
/// Violation of limits that a search may leave: what the next bodies change comes on top.
constexpr double tight_violation = 1e-7;
constexpr int most_designs = 30;

/// The largest change of a variable, relative to its value.
double relative_step(const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
  const Eigen::ArrayXd size = from.array().abs().max(to.array().abs()).max(1e-300);
  return ((to - from).array().abs() / size).maxCoeff();
}

/// @returns the best design of the region, or x if nothing could be evaluated
Eigen::VectorXd search_region(const MadeBodies& bodies, const Eigen::VectorXd& x, double radius,
                              const SolveOptions& options, const Execution& execution,
                              Result& before, const Observer& observer) {
  DesignProblem problem(bodies.continued_around(x, radius), execution.tasks.jobs, execution.store);
  problem.start_from(x);
  SolveOptions strict = options;
  strict.verdict.violation = tight_violation;
  Eigen::VectorXd found = x;
  before = run_after(before, observer, [&](const Observer& hears) {
    Result result = search_with_setting(problem, strict, hears);
    if (has_moved(result)) found = result.x;
    return result;
  });
  return found;
}

}  // namespace

Eigen::VectorXd search_between_calls(MadeBodies& bodies, const Eigen::VectorXd& x,
                                     const SolveOptions& options, const Execution& execution,
                                     Result& before, const Observer& observer,
                                     const Notice& notice) {
  double radius = first_radius;
  Eigen::VectorXd best = x;
  while (bodies.designs() < most_designs && radius > least_radius) {
    const Eigen::VectorXd next =
        search_region(bodies, best, radius, options, execution, before, observer);
    const double step = relative_step(best, next);
    if (step < small_step) break;
    try {
      const double error = bodies.make_at(next);
      notify(
          notice,
          fmt::format("bodies were made for design {}, {:.2g} % away; their stiffness was foretold "
                      "to {:.2g} %",
                      bodies.designs(), 100.0 * step, 100.0 * error));
      if (error < good_error) radius = std::min(2.0 * radius, largest_radius);
      if (error > bad_error) radius *= 0.5;
      radius = std::min(radius, longest_next_step * step);
      best = next;
    } catch (const SimulationError& failure) {
      notify(notice, fmt::format("{}: the next step is shorter", failure.what()));
      radius *= 0.25;
    }
  }
  return best;
}

}  // namespace pleuel
