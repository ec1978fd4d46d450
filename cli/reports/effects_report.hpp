#pragma once

#include <functional>
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

/// Table: effect, whether it is built, why.
std::string effects_text(const Model& model);

/// What changes of responses make of the optimal objective [SI].
using PriceOfChanges = std::function<double(const Eigen::VectorXd& changes)>;

/// Table: effect, the time that it costs, the response that would change most without it; at an
/// optimum with prices also what the optimum would lose or gain without it. Empty without
/// influences.
std::string influences_text(const ProblemFile& problem, const Eigen::VectorXd& values,
                            const std::vector<EffectInfluence>& influences,
                            const PriceOfChanges& price = {});

}  // namespace pleuel
