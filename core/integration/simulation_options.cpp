#include "core/integration/simulation_options.hpp"

#include <algorithm>
#include <cmath>

namespace pleuel {

double steps_within(double time, double step) {
  return std::ceil(time / step * (1.0 - 1e-12));
}

int step_count(const TimeIntegration& options) {
  return std::max(1, static_cast<int>(steps_within(options.end_time, options.step)));
}

std::vector<double> regular_instants(const SimulationOptions& options) {
  constexpr double round_off = 1e-9, least_distance = 0.25;  // of a step
  const int steps = step_count(options);
  const double end = options.end_time, h = end / steps;
  std::vector<double> breaks = options.breaks, instants = {0.0};
  std::sort(breaks.begin(), breaks.end());
  std::erase_if(breaks, [&](double time) { return !(end - time >= least_distance * h); });
  breaks.push_back(end);
  instants.reserve(static_cast<std::size_t>(steps) + 2 * breaks.size());
  double last = 0.0;
  for (const double time : breaks) {
    if (time - last < least_distance * h && time < end) continue;
    const double length = time - last, exact = length / h;
    const int count = std::max(1, static_cast<int>(std::ceil(exact - round_off * exact)));
    const bool is_regular = last == 0.0 && time == end;
    for (int i = 1; i < count; ++i) {
      instants.push_back(is_regular ? end * i / steps : last + length * i / count);
    }
    instants.push_back(time);
    last = time;
  }
  return instants;
}

}  // namespace pleuel
