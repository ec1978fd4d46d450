#include "core/scene/reading/effects_reader.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace pleuel {
namespace {

EffectChoice read_effect(const JsonNode& node) {
  return read_choice<EffectChoice>(
      node,
      {{"auto", EffectChoice::automatic}, {"on", EffectChoice::on}, {"off", EffectChoice::off}});
}

}  // namespace

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

EffectSettings read_effects(const JsonNode& node) {
  node.allow_keys({"spatial_motion", "geometric_stiffening", "rotary_inertia", "elasticity",
                   "axial_elasticity", "torsional_elasticity", "tolerance"});
  EffectSettings effects;
  for (const auto& [key, effect] :
       {std::pair("spatial_motion", &effects.spatial_motion),
        std::pair("geometric_stiffening", &effects.geometric_stiffening),
        std::pair("rotary_inertia", &effects.rotary_inertia),
        std::pair("elasticity", &effects.elasticity),
        std::pair("axial_elasticity", &effects.axial_elasticity),
        std::pair("torsional_elasticity", &effects.torsional_elasticity)}) {
    if (const auto choice = node.find(key)) *effect = read_effect(*choice);
  }
  if (const auto tolerance = node.find("tolerance")) {
    effects.tolerance = tolerance->number();
    if (!is_within(Range::below_one, effects.tolerance)) {
      tolerance->fail_with_value(rule_of(Range::below_one, quantities::pure_number));
    }
  }
  return effects;
}

}  // namespace pleuel
