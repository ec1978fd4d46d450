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

/// How a search is made, and who hears of it.
struct SearchSetup {
  SolveOptions options = {};
  Execution execution = {};  ///< its jobs are simulations at a time, of gradients by differences
  Observer observer = {};
  Notice notice = {};

  /// A problem that begins at a design.
  std::unique_ptr<DesignProblem> problem_at(ProblemFile file, const Eigen::VectorXd& x) const {
    auto problem =
        std::make_unique<DesignProblem>(std::move(file), execution.tasks.jobs, execution.store);
    problem->start_from(x);
    return problem;
  }
  /// The same with another observer.
  SearchSetup heard_by(const Observer& hears) const { return {options, execution, hears, notice}; }
};

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
/// @throws as solve()
StagedSolution solve_in_stages(const ProblemFile& file, const Eigen::VectorXd& start,
                               const SearchSetup& setup);

/// The same with bodies that are made anew for each design as they are.
StagedSolution solve_stages(const ProblemFile& file, const Eigen::VectorXd& start,
                            const SearchSetup& setup);

}  // namespace pleuel
