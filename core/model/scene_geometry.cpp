#include "core/model/scene_geometry.hpp"

#include "core/scene/visit_numbers.hpp"

namespace pleuel {

std::set<int> variables_of(const Body& body, const Scene& scene) {
  std::set<int> variables;
  const auto collect = [&](const Number& number, const Quantity&) {
    for (const int variable : number.variables()) variables.insert(variable);
  };
  visit_numbers(body, collect);
  if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
    visit_numbers(find_material(scene, beam->material), collect);
  }
  return variables;
}

}  // namespace pleuel
