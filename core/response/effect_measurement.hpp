#pragma once

/// What each effect brings, and what it costs.

#include <optional>
#include <string>
#include <vector>

#include "core/base/stopwatch.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

namespace pleuel {

/// The response that differs most between two simulations of one problem.
struct LargestChange {
  double relative = 0.0;  ///< infinite where one of them cannot be simulated
  std::string response;   ///< its name
};

/// Relative changes of values: |y − y₀| over the larger of |y₀| and a hundredth of the largest
/// magnitude in the history of y₀ (a value near zero says nothing of its own size). Differences
/// below 1e-9 of the largest magnitude in the histories of the same unit are round-off. Monitors
/// (balance of energy, drift of constraints) are left out.
LargestChange largest_change(const ProblemFile& problem, const Analysis& reference,
                             const Analysis& other);

/// The problem with its start at another design.
ProblemFile starting_at(ProblemFile problem, const Eigen::VectorXd& x);

/// The problem with all effects that the file does not forbid.
ProblemFile with_all_effects(ProblemFile problem);

/// Decides with the tolerance of the file which effects of beams are left out, at the start design:
/// estimates propose (estimate_effects()), simulations decide. The mechanism with all effects is
/// simulated once beside the proposed one; while a response changes by more than the tolerance,
/// what costs more than it on its own is taken back, or else what costs most. The decisions are
/// kept in EffectSettings::decisions, so that the model is the same at all designs. Does nothing
/// without a tolerance, or where estimates leave nothing out. Where the mechanism with all effects
/// cannot be simulated everything is built. Of a problem with load cases each decides for itself.
void decide_effects(ProblemFile& problem);

/// The problem of a file without what its tolerance leaves out at its start.
ProblemFile decided(UndecidedProblem problem);

/// The same at another design. What was decided before to be needed stays.
void decide_effects(ProblemFile& problem, const Eigen::VectorXd& x);

/// Leaves out at a design what estimates propose, all of it or nothing: with two simulations, where
/// decide_effects() may need one for each effect of each beam.
void try_to_leave_out(ProblemFile& problem, const Eigen::VectorXd& x);

/// One effect of one body, or of several together where it hardly changes anything.
struct EffectInfluence {
  std::vector<std::string> bodies;
  std::string effect;   ///< as in Model::effects
  std::string failure;  ///< why it cannot be simulated without (or with) it; empty: it can
  /// One a response: its value without the effect minus that with it, all others as they are [SI].
  Eigen::VectorXd changes;
  /// The same of unknowns of the equations of motion, and of iterations of Newton's method.
  int unknowns = 0, iterations = 0;
  /// What leaving it out changes of the processor time of a simulation, where that is asked for.
  std::optional<ComparedTime> time = {};
};

/// A response and how much of its value an effect changes.
struct LargestInfluence {
  Eigen::Index response = -1;  ///< none: nothing changes but by round-off
  double relative = 0.0;
};
LargestInfluence largest_influence(const Eigen::VectorXd& values, const Eigen::VectorXd& changes);

/// Relative changes above this count: the tolerance of effects, without one 0.1 %.
double change_that_counts(const EffectSettings& effects);

enum class InfluenceTimes { none, measured };

/// Simulates a design without each effect of each body that the file or a tolerance decides on where
/// it is built, with it where it is not. An effect is turned round in all bodies together; where that
/// changes a response by more than counts, or cannot be simulated, in both halves of them, and so on.
/// Effects that another one needs are not listed, nor those that change nothing of what is built.
/// @param times  measured: of each effect of each body, in turns (core/base/stopwatch.hpp)
std::vector<EffectInfluence> effect_influences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                               InfluenceTimes times = InfluenceTimes::none);

}  // namespace pleuel
