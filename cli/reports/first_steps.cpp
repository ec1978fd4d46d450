#include "cli/reports/first_steps.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
#include "core/base/stopwatch.hpp"

namespace pleuel {

namespace {

constexpr double enough_seconds = 0.1;
constexpr double largest_share = 1.0 / 3.0;  ///< of the simulation
constexpr double first_count = 16.0;         ///< of steps

/// Its first part. Intervals of responses may lie behind it.
ProblemFile beginning(ProblemFile problem, double end_time) {
  problem.simulation.end_time = end_time;
  problem.simulation.period = 0.0;
  problem.simulation.moves_by_bending = true;  // a lock is told without them
  for (ResponseSettings& response : problem.responses) {
    response.from.reset();
    response.to.reset();
  }
  return problem;
}

}  // namespace

FirstSteps take_first_steps(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const double end = problem.simulation.end_time;
  FirstSteps first;
  double window = std::min(first_count * problem.simulation.step, end), seconds = 0.0;
  double before = 0.0, seconds_before = 0.0;
  try {
    while (true) {
      const Stopwatch stopwatch;
      first.analysis = analyze(beginning(problem, window), x);
      seconds = stopwatch.seconds();
      if (before > 0.0 && (seconds >= enough_seconds || window >= largest_share * end)) break;
      if (window >= end) break;
      before = window;
      seconds_before = seconds;
      window = std::min(2.0 * window, end);
    }
  } catch (const SimulationError& error) {
    first.analysis.reset();
    first.failure = error.what();
    return first;
  }
  const double rate = before > 0.0 ? std::max(0.0, (seconds - seconds_before) / (window - before))
                                   : seconds / window;
  first.seconds = seconds + rate * (end - window);
  return first;
}

std::string about_text(double seconds) {
  return "about " + duration(seconds < 1.0 ? seconds : std::round(seconds));
}

}  // namespace pleuel
