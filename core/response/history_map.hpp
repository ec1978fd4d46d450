#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/response/reduced_value.hpp"

namespace pleuel {

/// A linear map from what a signal observes at all instants to the history of its response, as
/// people see it and as it is reduced. Values, windows of peaks, gradients and histories of
/// gradients know no more of it than this.
class HistoryMap {
 public:
  virtual ~HistoryMap() = default;

  /// Channels of the signal that make one channel of the history, ascending.
  virtual std::vector<int> observed_channels(int channel) const = 0;

  /// @param time      instants [s]
  /// @param range     that is reduced
  /// @param observed  channels of the signal × instants: all, or those of some channels of the
  ///                  history
  /// @returns channels of the history × instants
  virtual Eigen::MatrixXd apply(const Eigen::VectorXd& time, const StepRange& range,
                                const Eigen::MatrixXd& observed) const = 0;

  /// What a sample of the history is made from: samples of the signal are added.
  virtual void add_observed(const Eigen::VectorXd& time, const StepRange& range,
                            const Sample& sample, std::vector<Sample>& observed) const = 0;
};

}  // namespace pleuel
