#include "core/scene/reading/scene_reader.hpp"

#include <algorithm>

#include "core/scene/material_library.hpp"
#include "core/scene/reading/keyed_numbers.hpp"

namespace pleuel {
namespace {

/// Yield and endurance come before fracture, where these are numbers.
void check_strengths(const JsonNode& node, const Material& material) {
  if (!material.ultimate_strength || material.ultimate_strength->is_bound()) return;
  for (const auto& [key, strength] : {std::pair("strength", &material.strength),
                                      std::pair("endurance_limit", &material.endurance_limit)}) {
    if (!*strength || (*strength)->is_bound()) continue;
    if ((*strength)->constant <= material.ultimate_strength->constant) continue;
    node.at(key).fail_with_value("must not be more than the \"ultimate_strength\"");
  }
}

Material read_material(const std::string& name, const JsonNode& node, NumberReader& numbers) {
  constexpr auto keys = number_keys(KeysOf<Material>());
  node.allow_keys(words_of(keys, {"fatigue_exponent"}));
  Material material;
  material.name = name;
  read_numbers(node, keys, numbers, material);
  if (const auto exponent = node.find("fatigue_exponent")) {
    material.fatigue_exponent = numbers.fixed(*exponent, quantities::pure_number, Range::positive);
    if (*material.fatigue_exponent < 1.0) {
      exponent->fail_with_value(
          "must be at least 1 (k of Basquin's line, 5 to 15 for metals; its slope b is -1/k)");
    }
  }
  check_strengths(node, material);
  return material;
}

/// Those of the scene and those of the library that it does not replace.
std::vector<std::string> material_names(const Scene& scene) {
  std::vector<std::string> names = names_of(scene.materials);
  for (const Material& material : material_library()) {
    if (!find_named(scene.materials, material.name)) names.push_back(material.name);
  }
  return names;
}

/// Of the library, what the bodies are made of.
void add_library_materials(Scene& scene) {
  for (const Material& material : material_library()) {
    const bool is_used =
        std::any_of(scene.bodies.begin(), scene.bodies.end(), [&material](const Body& body) {
          const auto* beam = std::get_if<BeamBody>(&body.shape);
          return beam != nullptr && beam->material == material.name;
        });
    if (is_used && !find_named(scene.materials, material.name)) scene.materials.push_back(material);
  }
}

void read_bodies(const JsonNode& node, Scene& scene, NumberReader& numbers) {
  const std::vector<std::string> materials = material_names(scene);
  for (const auto& [name, body] : node.members()) {
    if (name == ground_name) body.fail("has the name that is kept for the ground");
    scene.bodies.push_back(read_body(name, body, materials, numbers));
  }
  if (scene.bodies.empty()) node.fail("has no body");
  add_library_materials(scene);
}

void read_joints(const JsonNode& node, Scene& scene, NumberReader& numbers) {
  std::vector<std::string> bodies = names_of(scene.bodies);
  bodies.emplace_back(ground_name);
  for (const auto& [name, joint] : node.members()) {
    scene.joints.push_back(read_joint(name, joint, bodies, numbers));
  }
}

}  // namespace

Scene read_scene(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"gravity", "catalogue", "materials", "bodies", "joints", "loads"});
  Scene scene;
  if (const auto gravity = node.find("gravity")) {
    scene.gravity = numbers.triple(*gravity, quantities::acceleration);
    for (const Number& component : scene.gravity) {
      if (component.is_bound()) gravity->fail("cannot be bound to a design variable");
    }
  }
  if (const auto materials = node.find("materials")) {
    for (const auto& [name, material] : materials->members()) {
      scene.materials.push_back(read_material(name, material, numbers));
    }
  }
  read_bodies(node.at("bodies"), scene, numbers);
  if (const auto joints = node.find("joints")) read_joints(*joints, scene, numbers);
  if (const auto loads = node.find("loads")) {
    for (const auto& [name, load] : loads->members()) {
      scene.loads.push_back(read_load(name, load, scene, numbers));
    }
  }
  return scene;
}

}  // namespace pleuel
