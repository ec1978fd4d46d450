#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/text/json.hpp"
#include "core/response/effect_influence.hpp"
#include "core/scene/problem_file.hpp"

/// What each effect that was measured brings and costs.
namespace pleuel {

/// What changes of responses make of the optimal objective [SI].
using PriceOfChanges = std::function<double(const Eigen::VectorXd& changes)>;

/// Effects that were measured at a design.
struct MeasuredEffects {
  const ProblemFile& problem;
  const Eigen::VectorXd& values;  ///< of the responses [SI]
  const std::vector<EffectInfluence>& influences;
  PriceOfChanges price = {};  ///< of an optimum with prices
};

/// One an influence, whether it matters: it changes a response or the optimum by more than the
/// tolerance of the file (0.1 % without one), relative; times, which differ from run to run, do not
/// count. Those that a simulation cannot do without do not count.
std::vector<bool> effects_that_matter(const MeasuredEffects& effects);

/// Adds "matters" to the effects of effects_document() that were measured.
void mark_effects(const MeasuredEffects& effects, Json& document);

/// Table: effect, the time that it costs, the response that would change most without it; with
/// prices also what the optimum would lose or gain without it. Those that do not matter are told in
/// one sentence, unless all are asked for. Empty without influences.
std::string influences_text(const MeasuredEffects& effects, bool shows_all);

/// "elasticity (crank, rod)"
std::string effect_of_bodies(const std::string& effect, const std::vector<std::string>& bodies);

}  // namespace pleuel
