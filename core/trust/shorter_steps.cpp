#include "core/trust/shorter_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/eager_matrices.hpp"
#include "core/integration/periodic_start.hpp"

namespace pleuel {

namespace {

/// From one step to the next. Where they change by more than 30 %, the scheme takes up the motion
/// anew.
constexpr double growth_of_steps = 0.25;
/// Of a number of steps.
constexpr double round_off_of_parts = 1e-6;

/// @param last  the step that ends there
double wanted_step(const std::vector<ShorterSteps>& stretches, double time, double last) {
  double step = std::numeric_limits<double>::infinity();
  for (const ShorterSteps& one : stretches) {
    if (time < one.begin) continue;
    step = std::min(step, one.step + growth_of_steps * std::max(0.0, time - one.end));
  }
  return std::isinf(step) ? step : std::min(step, (1.0 + growth_of_steps) * last);
}

int instant_of(const Trajectory& trajectory, double time) {
  const Eigen::VectorXd& all = trajectory.time;
  if (time == all(0) && trajectory.periodic) return trajectory.periodic->steps;
  return static_cast<int>(std::lower_bound(all.begin(), all.end(), time) - all.begin());
}

/// Those of the trajectory, and one shortly before each jump.
std::vector<double> fixed_instants(const Trajectory& trajectory,
                                   const std::vector<ShorterSteps>& stretches) {
  std::vector<double> instants(trajectory.time.begin(), trajectory.time.end());
  for (const ShorterSteps& one : stretches) {
    const int at = instant_of(trajectory, one.begin);
    if (at == 0) continue;
    const double step = trajectory.time(at) - trajectory.time(at - 1);
    instants.push_back(trajectory.time(at) - std::min(one.step, 0.5 * step));
  }
  std::sort(instants.begin(), instants.end());
  return instants;
}

}  // namespace

std::vector<double> instants_with(const Trajectory& trajectory,
                                  const std::vector<ShorterSteps>& stretches) {
  const std::vector<double> fixed = fixed_instants(trajectory, stretches);
  std::vector<double> instants = {fixed.front()};
  double last = std::numeric_limits<double>::infinity();
  for (const double end : fixed) {
    while (instants.back() < end) {
      const double begin = instants.back(), left = end - begin;
      const double parts =
          std::ceil(left / wanted_step(stretches, begin, last) - round_off_of_parts);
      instants.push_back(parts <= 1.0 ? end : begin + left / parts);
      last = instants.back() - begin;
    }
  }
  return instants;
}

}  // namespace pleuel
