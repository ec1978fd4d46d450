#include "sensitivity/history_gradients.hpp"

#include "sensitivity/sampled_gradients.hpp"

namespace pleuel {

namespace {

/// The rows of the signal that make the history: of a balance both, amount and rate.
std::vector<int> channels_of(const Response& response, const HistoryGradients& history) {
  if (response.is_balance()) return {0, 1};
  return {history.place};
}

/// A balance is a sum over the time before, and linear in amount and rate.
Eigen::MatrixXd balance_gradients(const Response& response, const Eigen::VectorXd& time,
                                  const Eigen::MatrixXd& amount, const Eigen::MatrixXd& rate) {
  Eigen::MatrixXd gradients(amount.rows(), amount.cols());
  for (Eigen::Index j = 0; j < gradients.cols(); ++j) {
    Eigen::MatrixXd changes(2, amount.rows());
    changes << amount.col(j).transpose(), rate.col(j).transpose();
    gradients.col(j) = balance_history(time, changes, response.steps(time)).transpose();
  }
  return gradients;
}

/// @param values  whose gradients the same run computes, too
/// @returns gradients of those and of the histories
ResponseDerivatives differentiate(Analysis& analysis, std::vector<SampledValue> values) {
  const Eigen::VectorXd& time = analysis.trajectory.time;
  const Eigen::Index asked = values.size();
  std::vector<HistoryGradients> histories;
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    const Response& response = analysis.responses[i];
    if (!response.history()) continue;
    const auto& samples = analysis.reductions[i].samples;
    const int place = samples.empty() || response.is_balance() ? 0 : samples.front().channel;
    histories.push_back({i, place, analysis.histories[i].row(place).transpose(), {}});
    for (const int channel : channels_of(response, histories.back())) {
      for (int step = 0; step < time.size(); ++step) {
        values.push_back({i, {{step, channel, 1.0}}});
      }
    }
  }
  if (values.empty()) return {};
  const Eigen::MatrixXd all = sampled_gradients(analysis, values, ExactMethod::direct);
  Eigen::Index next = asked;
  const auto take = [&] {
    next += time.size();
    return all.middleRows(next - time.size(), time.size());
  };
  for (HistoryGradients& history : histories) {
    const Response& response = analysis.responses[history.response];
    history.gradients = take();
    if (response.is_balance()) {
      history.gradients = balance_gradients(response, time, history.gradients, take());
    }
  }
  return {all.topRows(asked), std::move(histories)};
}

}  // namespace

std::vector<HistoryGradients> history_gradients(Analysis& analysis) {
  return differentiate(analysis, {}).histories;
}

ResponseDerivatives response_derivatives(Analysis& analysis) {
  return differentiate(analysis, response_values(analysis));
}

}  // namespace pleuel
