#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/error_bar.hpp"
#include "core/trust/refined_runs.hpp"

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
  bool is_met = false;  ///< else the setting with the smallest error is chosen
  /// Whether the modes of reduced beams or the tolerance of Newton's method, which are not chosen,
  /// miss the target by themselves.
  bool is_out_of_reach = false;
  std::vector<TriedSetting> tried;
  /// Of the responses that are asked for, at the design of the choice, without what is due to
  /// effects; empty where the target is not met.
  std::vector<std::optional<ErrorBar>> bars;
};

/// Where the error bars come from that are shown of what runs with the setting.
enum class JudgedBy {
  this_choice,  ///< its comparisons with finer runs, at the same design
  coarser_runs  ///< error_bars.hpp, at other designs; they are wider
};

/// The coarsest division from which a choice may begin: 256 to 512 steps, or those of the file if they are
/// fewer, and the elements of the file.
Refinement coarse_setting(const ProblemFile& problem);

/// Chooses steps and elements such that the errors of all responses that are asked for
/// (trusted_run.hpp) are within the target at this design, relative to their values
/// (core/base/relative_error.hpp). From `first` on steps and elements are refined by powers of two, as
/// order 2 says, until error bars (error_bars.hpp) are within the target and a run at half the step
/// agrees: steps that are far too large may agree with each other, as vibrations that they do not see
/// are damped out. Then the way goes back to fewer elements and to larger steps, by comparison with
/// these runs: differences are added to the errors that are known. Each run is made once. The step may
/// end up larger or smaller than that of the file. One simulation takes at most sixteen times the work
/// of that of the file, or a second or so where that is more. Steps that loads and drives are too fast
/// for (fast_laws.hpp) are not taken; where the balance of energy or loads over joints speak against
/// the steps in the end, they are halved up to three times.
/// @param target  relative error, in (0, 1)
/// @throws Stopped
SettingChoice choose_setting(const ProblemFile& problem, const Eigen::VectorXd& x, double target,
                             const Refinement& first, JudgedBy judged_by);

/// The same with effects: where the file gives no tolerance for them, those are left out that
/// estimates call small and that together change no response by more than a fifth of the target;
/// the rest is for steps and elements.
SettingChoice choose_setting_and_effects(const ProblemFile& problem, const Eigen::VectorXd& x,
                                         double target, const Refinement& first,
                                         JudgedBy judged_by);

}  // namespace pleuel
