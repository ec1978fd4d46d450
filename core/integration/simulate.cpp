#include "core/integration/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/integration/checkpointed_loop.hpp"

namespace pleuel {

int step_count(const TimeIntegration& options) {
  // A step that divides the time up to round-off is not shortened.
  return std::max(1, static_cast<int>(std::ceil(options.end_time / options.step * (1 - 1e-12))));
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

namespace {

CheckpointPlan make_plan(const Mechanism& mechanism, const SimulationOptions& options) {
  const double n = mechanism.system->coordinates(), m = mechanism.system->multipliers();
  const bool is_stabilized = options.formulation.constraints == ConstraintForm::stabilized_index_2;
  const double extra = is_stabilized ? m : options.formulation.is_projected ? 2 * n : 0;
  const double state = 3 * n + m + extra;
  return {sizeof(double) * state, sizeof(double) * (state + (is_stabilized ? 3 : 2) * n),
          options.memory};
}

/// All states, or nothing if they turn out not to fit into the memory.
std::optional<Trajectory> simulate_whole(TimeLoop loop, const CheckpointPlan& plan) {
  if (!plan.holds(loop.units() + 1.0)) return std::nullopt;
  loop.start(loop.units() + 1);
  for (int unit = 1; unit <= loop.units(); ++unit) {
    loop.advance(unit);
    if (!plan.holds(static_cast<double>(loop.instant() + 1))) return std::nullopt;
  }
  Trajectory trajectory = loop.end();
  trajectory.states = std::make_shared<StoredStates>(loop.window().take());
  return trajectory;
}

}  // namespace

Trajectory simulate(Mechanism& mechanism, const SimulationOptions& options,
                    const InstantObserver& observer) {
  const CheckpointPlan plan = make_plan(mechanism, options);
  if (auto whole = simulate_whole({mechanism, options, observer}, plan)) return std::move(*whole);
  return simulate_with_checkpoints({mechanism, options, observer}, plan);
}

}  // namespace pleuel
