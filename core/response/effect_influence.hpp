#pragma once

#include <string>
#include <vector>

#include "core/response/analysis.hpp"

/// What each effect brings, and what it costs.
namespace pleuel {

/// One effect of one beam.
struct EffectInfluence {
  std::string body, effect;  ///< as in Model::effects
  std::string failure;       ///< why it cannot be simulated without (or with) it; empty: it can
  /// One a response: its value without the effect minus that with it, all others as they are [SI].
  Eigen::VectorXd changes;
  double seconds = 0.0;  ///< processor time of a simulation with it, minus that without it
  double share = 0.0;    ///< the same over that with all effects as they are
};

/// Simulates a design once more for each effect of each beam that the file or a tolerance decides
/// on: without it where it is built, with it where it is not. Effects that another one needs are
/// not listed, nor those that change nothing of what is built.
std::vector<EffectInfluence> effect_influences(const ProblemFile& problem,
                                               const Eigen::VectorXd& x);

}  // namespace pleuel
