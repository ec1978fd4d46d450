#pragma once

#include <memory>
#include <vector>

#include "core/trust/setting_choice.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/solve.hpp"

/// Optimization of a problem file in stages: with coarse settings first where an accuracy is asked
/// for, and again where effects that were left out matter at the optimum.
namespace pleuel {

/// A part of an optimization that ran with one setting.
struct Stage {
  double target = 0.0;  ///< relative error that its setting was chosen for; 0: it was not chosen
  std::vector<TriedSetting> settings;  ///< only if it was: one a load case
  bool is_met = false;  ///< whether the settings have the target where they were chosen
  int settings_tried = 0;
  int evaluations = 0;
  double choice_seconds = 0.0;  ///< that finding the setting took
  double seconds = 0.0;         ///< of the evaluations
};

struct StagedSolution {
  Result result;                           ///< of all stages together
  std::unique_ptr<DesignProblem> problem;  ///< that of the last stage
  std::vector<Stage> stages;
};

/// solve_design() for a problem file. Where `accuracy` / `target` is given, the search begins with
/// what is needed for ten times the target (at most 1 %) at the start, unaudited; then steps,
/// elements and effects are chosen at the design that it found, for the target itself, and the run
/// goes on from there to the verdict. Where the error bars do not keep the target at the optimum,
/// the setting is chosen anew at that design, up to three times. Without a target the file is taken
/// as it is; effects that were left out by a tolerance but matter at the optimum are taken back,
/// and the run goes on. Each load case has a setting and effects of its own.
/// @param start      the first design [SI]
/// @param execution  its jobs are simulations at a time, of gradients by differences
/// @throws as solve()
StagedSolution solve_in_stages(const ProblemFile& file, const Eigen::VectorXd& start,
                               const SolveOptions& options, const Execution& execution,
                               const Observer& observer = {}, const Notice& notice = {});

/// The same with bodies that are made anew for each design as they are.
StagedSolution solve_stages(const ProblemFile& file, const Eigen::VectorXd& start,
                            const SolveOptions& options, const Execution& execution,
                            const Observer& observer, const Notice& notice);

}  // namespace pleuel
