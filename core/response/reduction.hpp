#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/response/reduced_value.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// The instants that lie on breaks [s].
BrokenInstants instants_at(const std::vector<double>& breaks, const Eigen::VectorXd& time);

/// All steps.
StepRange whole_range(const Eigen::VectorXd& time);

/// The steps within [from, to], both ends included; first > last if there are none.
StepRange steps_between(const Eigen::VectorXd& time, std::optional<double> from,
                        std::optional<double> to);

/// Which of several channels final, mean and integral take.
enum class AmongChannels {
  largest,           ///< the largest number
  largest_magnitude  ///< that with the largest magnitude, with its sign
};

/// Reduces a history over time (and over channels: the smallest for min, the largest for the
/// others). Peaks between steps are found by the parabola through three samples; at the ends of the
/// range, and where the history jumps (history_jump.hpp), they are samples. Where a range begins or
/// ends with a jump, that from within counts. rms, mean and integral use the
/// trapezoidal rule.
/// @param time    steps + 1 instants [s]
/// @param values  channels × (steps + 1)
/// @param range   at least two steps; by default all
Reduction reduce(OverTime kind, const Eigen::VectorXd& time, const Eigen::MatrixXd& values,
                 const StepRange& range, const BrokenInstants& breaks = {},
                 AmongChannels among = AmongChannels::largest);
Reduction reduce(OverTime kind, const Eigen::VectorXd& time, const Eigen::MatrixXd& values);

/// Whether it is the height of a peak: max, min, max-abs.
bool is_peak(OverTime kind);

/// The peak of each of `windows` equal stretches of a range. The reduction of the whole range is
/// the highest of them (the lowest for min); where two of them tie it has a kink, while each for
/// itself is smooth. Always so many: of a range with fewer steps, stretches coincide.
/// @param kind  for which is_peak() holds
std::vector<Reduction> reduce_windows(OverTime kind, const Eigen::VectorXd& time,
                                      const Eigen::MatrixXd& values, int windows,
                                      const StepRange& range, const BrokenInstants& breaks = {});
std::vector<Reduction> reduce_windows(OverTime kind, const Eigen::VectorXd& time,
                                      const Eigen::MatrixXd& values, int windows);

}  // namespace pleuel
