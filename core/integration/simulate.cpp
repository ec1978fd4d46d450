#include "core/integration/simulate.hpp"

#include "core/integration/periodic_simulation.hpp"
#include "core/integration/plain_simulation.hpp"

namespace pleuel {

Trajectory simulate(Mechanism& mechanism, const SimulationOptions& options,
                    const InstantObserver& observer) {
  if (options.period > 0.0) return simulate_periodic(mechanism, options, observer);
  return simulate_plainly(mechanism, options, observer);
}

}  // namespace pleuel
