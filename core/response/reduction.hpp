#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// One observed number that a reduced value depends on: d(value)/d(y[step, channel]) = weight.
struct Sample {
  int step;
  int channel;
  double weight;
};

/// Two peaks of nearly the same height: the maximum has a kink there, and its gradient is that of
/// the higher peak only.
struct PeakTie {
  double time, other_time;  ///< [s]
  int channel, other_channel;
  double gap;  ///< relative difference of the heights
};

/// A history reduced to one number, linearised in the observed numbers.
struct Reduction {
  double value = 0.0;
  std::vector<Sample> samples;
  std::optional<PeakTie> tie;
};

/// Reduces a history over time (and over channels: the largest for max, min, max-abs, rms; the only
/// one otherwise). Peaks between steps are found by the parabola through three samples; rms, mean
/// and integral use the trapezoidal rule.
/// @param time    steps + 1 instants, equidistant [s]
/// @param values  channels × (steps + 1)
Reduction reduce(OverTime kind, const Eigen::VectorXd& time, const Eigen::MatrixXd& values);

}  // namespace pleuel
