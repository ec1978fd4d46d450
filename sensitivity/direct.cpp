#include "sensitivity/direct.hpp"

#include "core/integration/step_differentiation.hpp"
#include "sensitivity/initial_sensitivity.hpp"

namespace pleuel {

void differentiate(Mechanism& mechanism, const Trajectory& trajectory,
                   const SensitivityObserver& observer) {
  differentiate_until(trajectory.steps(), mechanism, trajectory, observer);
}

void differentiate_until(int last_step, Mechanism& mechanism, const Trajectory& trajectory,
                         const SensitivityObserver& observer) {
  const State start = trajectory.state_at(0);
  StateSensitivity initial = trajectory.periodic
                                 ? periodic_sensitivity(mechanism, trajectory)
                                 : initial_sensitivity(mechanism, initial_state(mechanism));
  observer(0, start, initial);
  if (!trajectory.periodic) {
    initial = first_step_sensitivity(mechanism, trajectory, start, std::move(initial));
  }
  StepDifferentiation motion(mechanism, trajectory, DerivativesOf::design);
  motion.begin(std::move(initial));
  while (motion.step() < last_step && motion.advance()) {
    observer(motion.step(), motion.state(), motion.sensitivity());
  }
}

}  // namespace pleuel
