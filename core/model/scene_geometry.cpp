#include "core/model/scene_geometry.hpp"

#include "core/scene/visit_numbers.hpp"

namespace pleuel {

std::set<int> variables_of(const Body& body, const Scene& scene) {
  std::set<int> variables;
  add_variables_of(body, variables);
  if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
    add_variables_of(find_material(scene, beam->material), variables);
  }
  return variables;
}

}  // namespace pleuel
