#include "core/integration/plain_simulation.hpp"

#include <optional>

#include "core/integration/checkpointed_loop.hpp"

namespace pleuel {

namespace {

CheckpointPlan make_plan(const Mechanism& mechanism, const SimulationOptions& options) {
  const double n = mechanism.system->coordinates(), m = mechanism.system->multipliers();
  const bool is_stabilized = options.formulation.constraints == ConstraintForm::stabilized_index_2;
  const double extra = is_stabilized ? m : options.formulation.is_projected ? 2 * n : 0;
  const double state = 3 * n + m + extra;
  // Besides the state: w, the increment, the shift, and how a and λ changed last.
  const double more = (is_stabilized ? 4 : 3) * n + m;
  return {sizeof(double) * state, sizeof(double) * (state + more), options.memory};
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

Trajectory simulate_plainly(Mechanism& mechanism, const SimulationOptions& options,
                            const InstantObserver& observer, const SchemeState* start) {
  const CheckpointPlan plan = make_plan(mechanism, options);
  if (auto whole = simulate_whole({mechanism, options, observer, start}, plan)) {
    return std::move(*whole);
  }
  return simulate_with_checkpoints({mechanism, options, observer, start}, plan);
}

}  // namespace pleuel
