#include "sensitivity/gradients.hpp"

#include <map>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "sensitivity/direct.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/frequency_sensitivity.hpp"

namespace pleuel {

std::string to_string(GradientMethod method) {
  switch (method) {
    case GradientMethod::direct:
      return "direct";
    case GradientMethod::forward_difference:
      return "forward-difference";
    default:
      return "central-difference";
  }
}

GradientMethod gradient_method(const std::string& name) {
  for (auto method : {GradientMethod::direct, GradientMethod::forward_difference,
                      GradientMethod::central_difference}) {
    if (to_string(method) == name) return method;
  }
  throw InputError(
      fmt::format("there is no gradient method \"{}\"; known are direct, forward-difference, "
                  "central-difference",
                  name));
}

namespace {

struct Use {
  std::size_t value;
  int channel;
  double weight;
};

/// Which samples of which values are needed at each step.
std::map<int, std::vector<Use>> samples_by_step(const std::vector<SampledValue>& values) {
  std::map<int, std::vector<Use>> steps;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const Sample& sample : values[i].samples) {
      steps[sample.step].push_back({i, sample.channel, sample.weight});
    }
  }
  return steps;
}

}  // namespace

namespace {

/// Takes off the gradients of what is measured in the mechanism without elasticity.
void subtract_rigid_mechanism(Analysis& analysis, const std::vector<SampledValue>& values,
                              Eigen::MatrixXd& gradients) {
  std::vector<SampledValue> rigid_values;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& rigid = analysis.responses[values[i].response].rigid_response;
    if (!rigid) continue;
    rigid_values.push_back({*rigid, values[i].samples});
    rows.push_back(static_cast<Eigen::Index>(i));
  }
  if (rows.empty()) return;
  gradients(rows, Eigen::all) -= direct_gradients(*analysis.rigid, rigid_values);
}

}  // namespace

Eigen::MatrixXd direct_gradients(Analysis& analysis, const std::vector<SampledValue>& values) {
  const System& system = *analysis.model.mechanism.system;
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(values.size()), system.variables());
  std::vector<std::size_t> of_initial_state;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Response& response = analysis.responses[values[i].response];
    if (response.mechanism_mode) {
      of_initial_state.push_back(i);
    } else if (!response.signal) {
      result.row(static_cast<Eigen::Index>(i)) = response.constant_x.transpose();
    }
  }
  const auto uses = samples_by_step(values);
  if ((uses.empty() && of_initial_state.empty()) || system.variables() == 0) return result;
  const auto set_frequencies = [&](const State& state, const StateSensitivity& s) {
    for (std::size_t i : of_initial_state) {
      const int mode = *analysis.responses[values[i].response].mechanism_mode;
      result.row(static_cast<Eigen::Index>(i)) =
          frequency_sensitivity(analysis.model.mechanism, state, s, mode).transpose();
    }
  };
  SignalGradient gradient(system.coordinates(), system.multipliers(), system.variables());
  const SignalGradient zero = gradient;
  differentiate(analysis.model.mechanism, analysis.trajectory,
                [&](int step, const State& state, const StateSensitivity& s) {
                  if (step == 0) set_frequencies(state, s);
                  const auto found = uses.find(step);
                  if (found == uses.end()) return;
                  for (const Use& use : found->second) {
                    gradient = zero;
                    Signal& signal = *analysis.responses[values[use.value].response].signal;
                    signal.add_gradient(state, use.channel, use.weight, gradient);
                    result.row(static_cast<Eigen::Index>(use.value)) +=
                        gradient.q.transpose() * s.q + gradient.v.transpose() * s.v +
                        gradient.a.transpose() * s.a + gradient.lambda.transpose() * s.lambda +
                        gradient.design.transpose();
                  }
                });
  subtract_rigid_mechanism(analysis, values, result);
  return result;
}

Eigen::MatrixXd direct_gradients(Analysis& analysis) {
  std::vector<SampledValue> values;
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    values.push_back({i, analysis.reductions[i].samples});
  }
  return direct_gradients(analysis, values);
}

Eigen::MatrixXd gradients(const ProblemFile& problem, const Eigen::VectorXd& x, Analysis& analysis,
                          GradientMethod method, const GradientOptions& options) {
  switch (method) {
    case GradientMethod::direct:
      return direct_gradients(analysis);
    case GradientMethod::forward_difference:
      return forward_differences(with_steps_of(analysis.trajectory, problem), x, analysis,
                                 options.difference_step);
    default:
      return central_differences(with_steps_of(analysis.trajectory, problem), x,
                                 options.difference_step);
  }
}

}  // namespace pleuel
