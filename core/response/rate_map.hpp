#pragma once

#include "core/response/history_map.hpp"

namespace pleuel {

/// The derivative of every channel with respect to time: of the parabola through three instants, at
/// the first and the last instant that of the three next to it; through two where there are no more.
class RateMap final : public HistoryMap {
 public:
  std::vector<int> observed_channels(int channel) const override;
  Eigen::MatrixXd apply(const Eigen::VectorXd& time, const StepRange& range,
                        const Eigen::MatrixXd& observed) const override;
  void add_observed(const Eigen::VectorXd& time, const StepRange& range, const Sample& sample,
                    std::vector<Sample>& observed) const override;
};

}  // namespace pleuel
