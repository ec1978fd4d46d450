#pragma once

#include "cli/text/json.hpp"
#include "core/model/model.hpp"
#include "core/response/effect_measurement.hpp"

/// Which effects are simulated, why, and what each of them brings and costs.
namespace pleuel {

/// [{"name", "body", "built", "decision", "reason", "estimate", "coordinates_saved", "influence",
/// "seconds"}]: the last two of effects whose influence was measured [SI].
Json effects_document(const ProblemFile& problem, const Model& model,
                      const std::vector<EffectInfluence>& influences = {});

/// Table: effect, whether it is built, why; effects of several bodies that are decided alike stand in
/// one row.
std::string effects_text(const Model& model);

/// "Left out: spatial_motion, torsional_elasticity (crank, rod)." Empty if nothing is.
std::string left_out_text(const Model& model);

/// What changes of responses make of the optimal objective [SI].
using PriceOfChanges = std::function<double(const Eigen::VectorXd& changes)>;

/// Effects that were measured at a design.
struct MeasuredEffects {
  const ProblemFile& problem;
  const Eigen::VectorXd& values;  ///< of the responses [SI]
  const std::vector<EffectInfluence>& influences;
  PriceOfChanges price = {};  ///< of an optimum with prices
};

/// Adds "matters" to the effects of effects_document() that were measured.
void mark_effects(const MeasuredEffects& effects, Json& document);

/// Table: effect, the time that it costs, the response that would change most without it; with
/// prices also what the optimum would lose or gain without it. Those that do not matter are told in
/// one sentence, unless all are asked for. Empty without influences.
std::string influences_text(const MeasuredEffects& effects, bool shows_all);

}  // namespace pleuel
