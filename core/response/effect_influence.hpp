#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/compared_times.hpp"
#include "core/response/analysis.hpp"

/// What each effect brings, and what it costs.
namespace pleuel {

/// One effect of one beam or imported body.
struct EffectInfluence {
  std::string body, effect;  ///< as in Model::effects
  std::string failure;       ///< why it cannot be simulated without (or with) it; empty: it can
  /// One a response: its value without the effect minus that with it, all others as they are [SI].
  Eigen::VectorXd changes;
  /// The same of unknowns of the equations of motion, and of iterations of Newton's method.
  int unknowns = 0, iterations = 0;
  /// What leaving it out changes of the processor time of a simulation, where that is asked for.
  std::optional<ComparedTime> time = {};
};

enum class InfluenceTimes { none, measured };

/// Simulates a design once more for each effect of each body that the file or a tolerance decides
/// on: without it where it is built, with it where it is not. Effects that another one needs are
/// not listed, nor those that change nothing of what is built.
/// @param times  measured: all of them in turns (core/base/compared_times.hpp)
std::vector<EffectInfluence> effect_influences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                               InfluenceTimes times = InfluenceTimes::none);

}  // namespace pleuel
