#include "sensitivity/periodic_sensitivity.hpp"

#include <string>

#include "core/base/error.hpp"
#include "core/integration/period_map.hpp"
#include "core/integration/periodic_start.hpp"
#include "core/integration/repetition.hpp"
#include "core/integration/step_differentiation.hpp"
#include "sensitivity/periodic_correction.hpp"

namespace pleuel {

namespace {

StateSensitivity zero_sensitivity(const System& system) {
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(system.coordinates(), system.variables());
  return {zero, zero, zero, zero, Eigen::MatrixXd::Zero(system.multipliers(), system.variables())};
}

}  // namespace

void require_repeated_derivatives(Mechanism& mechanism, const Trajectory& trajectory) {
  const PeriodicStart& periodic = *trajectory.periodic;
  const std::string complaint =
      complaint_about_repeated_derivatives(mechanism, trajectory, periodic.steps, periodic.period);
  if (!complaint.empty()) throw SimulationError(complaint);
}

StateSensitivity periodic_sensitivity(Mechanism& mechanism, const Trajectory& trajectory) {
  const PeriodicStart& periodic = *trajectory.periodic;
  require_repeated_derivatives(mechanism, trajectory);
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
