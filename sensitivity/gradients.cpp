#include "sensitivity/gradients.hpp"

#include <cassert>

#include "core/base/int_size.hpp"
#include "core/response/history_reduction.hpp"
#include "sensitivity/method_choice.hpp"

namespace pleuel {

namespace {

/// Channels of the signal that make a channel of the history.
std::vector<int> observed_channels(const Response& response, int channel) {
  const auto& map = response.history()->map;
  return map ? map->observed_channels(channel) : std::vector<int>{channel};
}

/// @param observed  of those channels, one after the other: (channels · instants) × variables
/// @returns instants × variables
Eigen::MatrixXd mapped(const Response& response, const Eigen::VectorXd& time,
                       const Eigen::MatrixXd& observed) {
  const auto& map = response.history()->map;
  if (!map) return observed;
  const StepRange range = response.steps(time);
  const Eigen::Index instants = time.size();
  Eigen::MatrixXd gradients(instants, observed.cols());
  for (Eigen::Index j = 0; j < observed.cols(); ++j) {
    const auto changes = observed.col(j).reshaped(instants, observed.rows() / instants).transpose();
    gradients.col(j) = map->apply(time, range, changes).transpose();
  }
  return gradients;
}

/// @param values  whose gradients the same run computes, too
/// @returns gradients of those and of the histories
ResponseDerivatives differentiate(Analysis& analysis, std::vector<SampledValue> values) {
  const Eigen::VectorXd& time = analysis.trajectory.time;
  const Eigen::Index asked = values.size();
  for (SampledValue& value : values) {
    value.samples = observed_samples(analysis.responses[value.response], time, value.samples);
  }
  std::vector<HistoryGradients> histories;
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    const Response& response = analysis.responses[i];
    if (!response.history()) continue;
    const auto& samples = analysis.reductions[i].samples;
    const int place = samples.empty() ? 0 : samples.front().channel;
    histories.push_back({i, place, analysis.histories[i].row(place).transpose(), {}});
    for (const int channel : observed_channels(response, place)) {
      for (int step = 0; step < int_size(time); ++step) {
        values.push_back({i, {{step, channel, 1.0}}});
      }
    }
  }
  if (values.empty()) return {};
  const Eigen::MatrixXd all = observed_gradients(analysis, values, ExactMethod::direct);
  Eigen::Index next = asked;
  for (HistoryGradients& history : histories) {
    const Response& response = analysis.responses[history.response];
    const Eigen::Index count = time.size() * int_size(observed_channels(response, history.place));
    history.gradients = mapped(response, time, all.middleRows(next, count));
    next += count;
  }
  return {all.topRows(asked), std::move(histories)};
}

}  // namespace

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

std::vector<HistoryGradients> history_gradients(Analysis& analysis) {
  return differentiate(analysis, {}).histories;
}

ResponseDerivatives response_derivatives(Analysis& analysis) {
  return differentiate(analysis, response_values(analysis));
}

}  // namespace pleuel
