#pragma once

#include "core/response/history_map.hpp"

namespace pleuel {

/// What is missing in a balance of an amount and its rate since the first step of the range, by the
/// trapezoidal rule: amount(t) − amount(t₀) − ∫ rate dt. The signal observes both, one after the
/// other.
class BalanceMap final : public HistoryMap {
 public:
  std::vector<int> observed_channels(int channel) const override;
  Eigen::MatrixXd apply(const Eigen::VectorXd& time, const StepRange& range,
                        const Eigen::MatrixXd& observed) const override;
  void add_observed(const Eigen::VectorXd& time, const StepRange& range, const Sample& sample,
                    std::vector<Sample>& observed) const override;
};

}  // namespace pleuel
