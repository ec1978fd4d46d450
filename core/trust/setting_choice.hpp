#pragma once

#include <string>
#include <vector>

#include "core/trust/nested_runs.hpp"

/// Steps and elements for an accuracy, instead of an accuracy for steps and elements.
namespace pleuel {

/// A setting and what was found of it.
struct TriedSetting {
  Refinement setting;    ///< of the file
  double step = 0.0;     ///< [s]
  int elements = 0;      ///< of all elastic beams
  double error = 0.0;    ///< relative, the largest of the responses that are asked for; infinite
                         ///< where it is not resolved
  std::string response;  ///< that has it
  double work = 0.0;     ///< steps × unknowns
};

struct SettingChoice {
  ProblemFile problem;  ///< divided as chosen
  TriedSetting chosen;  ///< with the error that was found in the end
  bool is_met = false;  ///< else the finest setting that was tried is chosen
  std::vector<TriedSetting> tried;
};

/// The coarsest division from which a choice may begin: 256 steps, or those of the file if they are
/// fewer, and the elements of the file.
Refinement coarse_setting(const ProblemFile& problem);

/// Chooses steps and elements such that the error bars (error_bars.hpp) of all responses that are
/// asked for (asked_responses.hpp) are within the target at this design, relative to their values
/// (core/base/relative_error.hpp). From `first` on steps and elements are refined as order 2 says,
/// until the bars are within the target and a run at a quarter of the step, or at the step of the
/// file if that is smaller, agrees: steps that are far too large may agree with each other, as
/// vibrations that they do not see are damped out. Then the way goes back to larger steps and to
/// half the elements, as long as their values are those that were found, to half the target. The
/// step may end up larger or smaller than that of the file.
/// @param target  relative error, in (0, 1)
/// @throws Stopped
SettingChoice choose_setting(const ProblemFile& problem, const Eigen::VectorXd& x, double target,
                             const Refinement& first);

}  // namespace pleuel
