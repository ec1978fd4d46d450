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
