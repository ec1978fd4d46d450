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

}  // namespace

std::vector<HistoryGradients> history_gradients(Analysis& analysis) {
  const Eigen::VectorXd& time = analysis.trajectory.time;
  std::vector<HistoryGradients> histories;
  std::vector<SampledValue> values;
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
  if (histories.empty()) return histories;
  const Eigen::MatrixXd all = sampled_gradients(analysis, values, ExactMethod::direct);
  Eigen::Index next = 0;
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
  return histories;
}

}  // namespace pleuel
