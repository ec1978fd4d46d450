#include "core/response/balance_map.hpp"

#include <algorithm>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

std::vector<int> BalanceMap::observed_channels(int channel) const {
  return {2 * channel, 2 * channel + 1};
}

Eigen::MatrixXd BalanceMap::apply(const Eigen::VectorXd& time, const StepRange& range,
                                  const Eigen::MatrixXd& observed) const {
  const Eigen::Index channels = observed.rows() / 2;
  Eigen::MatrixXd missing(channels, time.size());
  for (Eigen::Index k = 0; k < channels; ++k) {
    const auto amount = observed.row(2 * k), rate = observed.row(2 * k + 1);
    Eigen::RowVectorXd gained = Eigen::RowVectorXd::Zero(time.size());
    for (Eigen::Index i = 1; i < time.size(); ++i) {
      gained(i) = gained(i - 1) + 0.5 * (time(i) - time(i - 1)) * (rate(i - 1) + rate(i));
    }
    const Eigen::RowVectorXd all = amount - gained;
    missing.row(k) = all.array() - all(range.first);
  }
  return missing;
}

void BalanceMap::add_observed(const Eigen::VectorXd& time, const StepRange& range,
                              const Sample& sample, std::vector<Sample>& observed) const {
  const int amount = 2 * sample.channel, rate = amount + 1;
  if (sample.step == range.first) return;
  observed.push_back({range.first, amount, -sample.weight});
  observed.push_back({sample.step, amount, sample.weight});
  const auto [first, last] = std::minmax(range.first, sample.step);
  const double sign = sample.step > range.first ? -1.0 : 1.0;
  for (int i = first; i <= last; ++i) {
    const double before = i > first ? time(i) - time(i - 1) : 0.0;
    const double behind = i < last ? time(i + 1) - time(i) : 0.0;
    observed.push_back({i, rate, sign * sample.weight * 0.5 * (before + behind)});
  }
}

}  // namespace pleuel
