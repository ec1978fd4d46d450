#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/response/reduced_value.hpp"

namespace pleuel {

/// Limits from within at the ends of a range that lie on a jump, as a window that begins when a
/// load is let go: the sample there is the mean of both sides. Along the straight line through the
/// two samples within, of those channels that jump.
class LimitsAtEnds {
 public:
  /// @param values  channels × instants
  /// @param breaks  where channels may jump
  LimitsAtEnds(const Eigen::MatrixXd& values, const StepRange& range, const BrokenInstants& breaks);

  bool is_empty() const { return limits_.empty(); }
  /// The values with the limits in place.
  Eigen::MatrixXd applied() const;
  /// Samples of limits become those that they are made from.
  void restore(Reduction& reduction) const;

 private:
  struct Limit {
    int step, within, channel;  ///< within: ±1
  };
  void look_at(int step, int within, const StepRange& range, const BrokenInstants& breaks);
  void restore(std::vector<Sample>& samples) const;

  const Eigen::MatrixXd& values_;
  std::vector<Limit> limits_;
};

}  // namespace pleuel
