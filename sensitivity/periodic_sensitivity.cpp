#include "sensitivity/periodic_sensitivity.hpp"

#include "core/integration/period_map.hpp"
#include "core/integration/periodic_start.hpp"
#include "core/integration/step_differentiation.hpp"
#include "sensitivity/periodic_correction.hpp"

namespace pleuel {

namespace {

StateSensitivity zero_sensitivity(const System& system) {
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(system.coordinates(), system.variables());
  return {zero, zero, zero, zero, Eigen::MatrixXd::Zero(system.multipliers(), system.variables())};
}

}  // namespace

StateSensitivity periodic_sensitivity(Mechanism& mechanism, const Trajectory& trajectory) {
  const PeriodicStart& periodic = *trajectory.periodic;
  const StackedStates& states = periodic.map->states();
  StateSensitivity start = zero_sensitivity(*mechanism.system);
  StepDifferentiation motion(mechanism, trajectory, DerivativesOf::design);
  PeriodicCorrection progress;
  while (true) {
    motion.begin(start);
    while (motion.step() < periodic.steps) motion.advance();
    const Eigen::MatrixXd end = states.stack(motion.sensitivity()), gap = end - states.stack(start);
    start.lambda = motion.sensitivity().lambda;
    if (progress.is_done(gap, end)) return start;
    const StateSensitivity step = states.unstack(periodic.map->solve(gap));
    start.q += step.q;
    start.v += step.v;
    start.a += step.a;
    start.w += step.w;
  }
}

}  // namespace pleuel
