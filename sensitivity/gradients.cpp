#include "sensitivity/gradients.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/method_choice.hpp"

namespace pleuel {

std::string to_string(GradientMethod method) {
  switch (method) {
    case GradientMethod::automatic:
      return "auto";
    case GradientMethod::direct:
      return "direct";
    case GradientMethod::adjoint:
      return "adjoint";
    case GradientMethod::forward_difference:
      return "forward-difference";
    default:
      return "central-difference";
  }
}

GradientMethod gradient_method(const std::string& name) {
  std::string known;
  for (auto method : {GradientMethod::automatic, GradientMethod::direct, GradientMethod::adjoint,
                      GradientMethod::forward_difference, GradientMethod::central_difference}) {
    if (to_string(method) == name) return method;
    known += (known.empty() ? "" : ", ") + to_string(method);
  }
  throw InputError(fmt::format("there is no gradient method \"{}\"; known are {}", name, known));
}

Eigen::MatrixXd direct_gradients(Analysis& analysis) {
  return sampled_gradients(analysis, response_values(analysis), ExactMethod::direct);
}

Eigen::MatrixXd gradients(const ProblemFile& problem, const Eigen::VectorXd& x, Analysis& analysis,
                          GradientMethod method, const GradientOptions& options) {
  const std::vector<SampledValue> values = response_values(analysis);
  switch (method) {
    case GradientMethod::automatic:
      return sampled_gradients(analysis, values, choose_method(analysis, values).method);
    case GradientMethod::direct:
      return sampled_gradients(analysis, values, ExactMethod::direct);
    case GradientMethod::adjoint:
      return sampled_gradients(analysis, values, ExactMethod::adjoint);
    case GradientMethod::forward_difference:
      return forward_differences(with_steps_of(analysis.trajectory, problem), x, analysis,
                                 options.difference_step, options.threads);
    default:
      return central_differences(with_steps_of(analysis.trajectory, problem), x,
                                 options.difference_step, options.threads);
  }
}

}  // namespace pleuel
