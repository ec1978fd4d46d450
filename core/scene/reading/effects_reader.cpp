#include "core/scene/reading/effects_reader.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/scene/reading/key_reader.hpp"

namespace pleuel {

void check_effects(const JsonNode& node, const ProblemFile& problem) {
  const EffectSettings& effects = problem.effects;
  const bool has_elastic_body =
      std::any_of(problem.scene.bodies.begin(), problem.scene.bodies.end(), [](const Body& body) {
        const auto* beam = std::get_if<BeamBody>(&body.shape);
        return std::holds_alternative<ImportedBody>(body.shape) || (beam && !beam->is_rigid);
      });
  const bool is_rigid = effects.elasticity == EffectChoice::off;
  for (const auto& [key, choice] :
       {std::pair("elasticity", effects.elasticity),
        std::pair("axial_elasticity", effects.axial_elasticity),
        std::pair("torsional_elasticity", effects.torsional_elasticity),
        std::pair("geometric_stiffening", effects.geometric_stiffening)}) {
    if (choice != EffectChoice::on) continue;
    if (!has_elastic_body) node.at(key).fail("is \"on\", but all bodies are rigid");
    if (is_rigid) node.at(key).fail("is \"on\", but /effects/elasticity is \"off\"");
  }
  if (effects.geometric_stiffening == EffectChoice::on &&
      effects.axial_elasticity == EffectChoice::off) {
    node.at("geometric_stiffening")
        .fail(
            "is \"on\", but /effects/axial_elasticity is \"off\": the axial force that stiffens "
            "comes from axial strain; leave out \"axial_elasticity\", or set it to \"on\"");
  }
}

EffectSettings read_effects(const JsonNode& node, NumberReader& numbers) {
  EffectSettings effects;
  read_keys(node, numbers, effects);
  return effects;
}

}  // namespace pleuel
