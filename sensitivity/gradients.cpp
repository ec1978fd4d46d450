#include "sensitivity/gradients.hpp"

#include <cassert>

#include "sensitivity/method_choice.hpp"

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

}  // namespace pleuel
