#include "sensitivity/gradients.hpp"

#include <cassert>

#include "core/integration/step_differentiation.hpp"
#include "sensitivity/initial_sensitivity.hpp"
#include "sensitivity/method_choice.hpp"
#include "sensitivity/periodic_sensitivity.hpp"

namespace pleuel {

bool is_difference(GradientMethod method) {
  return method == GradientMethod::forward_difference ||
         method == GradientMethod::central_difference;
}

ExactMethod exact_method(GradientMethod method) {
  assert(method == GradientMethod::direct || method == GradientMethod::adjoint);
  return method == GradientMethod::direct ? ExactMethod::direct : ExactMethod::adjoint;
}

GradientChoice choose_gradients(GradientMethod asked, Analysis& analysis,
                                const std::vector<SampledValue>& values) {
  if (asked != GradientMethod::automatic) return {asked, "asked for"};
  const MethodChoice choice = choose_method(analysis, values);
  return {choice.method == ExactMethod::direct ? GradientMethod::direct : GradientMethod::adjoint,
          choice.reason};
}

Eigen::MatrixXd direct_gradients(Analysis& analysis) {
  return sampled_gradients(analysis, response_values(analysis), ExactMethod::direct);
}

Eigen::MatrixXd gradients_by_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                         const Analysis& analysis, GradientMethod method,
                                         const ValuesOf& values, const GradientOptions& options) {
  assert(is_difference(method));
  const ProblemFile repeated = with_steps_of(analysis.trajectory, problem);
  if (method == GradientMethod::central_difference) {
    return central_differences(repeated, x, options.difference_step, options.threads, values);
  }
  return forward_differences(repeated, x, analysis, options.difference_step, options.threads,
                             values);
}

Eigen::MatrixXd gradients(const ProblemFile& problem, const Eigen::VectorXd& x, Analysis& analysis,
                          GradientMethod method, const GradientOptions& options) {
  const std::vector<SampledValue> values = response_values(analysis);
  const GradientMethod chosen = choose_gradients(method, analysis, values).method;
  if (is_difference(chosen)) {
    return gradients_by_differences(problem, x, analysis, chosen, values_of, options);
  }
  return sampled_gradients(analysis, values, exact_method(chosen));
}

void differentiate(Mechanism& mechanism, const Trajectory& trajectory,
                   const SensitivityObserver& observer) {
  differentiate_until(trajectory.steps(), mechanism, trajectory, observer);
}

void differentiate_until(int last_step, Mechanism& mechanism, const Trajectory& trajectory,
                         const SensitivityObserver& observer) {
  State start;
  trajectory.states->load(0, start);
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
