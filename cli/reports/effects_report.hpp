#pragma once

#include <string>
#include <vector>

#include "cli/text/json.hpp"
#include "core/model/model.hpp"
#include "core/response/effect_influence.hpp"
#include "core/scene/problem_file.hpp"

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

}  // namespace pleuel
