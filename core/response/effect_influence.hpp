#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/stopwatch.hpp"
#include "core/response/analysis.hpp"

/// What each effect brings, and what it costs.
namespace pleuel {

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
