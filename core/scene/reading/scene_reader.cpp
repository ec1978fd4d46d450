#include "core/scene/reading/scene_reader.hpp"

#include <algorithm>

#include "core/scene/material_library.hpp"
#include "core/scene/reading/mistakes.hpp"

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
  Material material;
  read_keys(node, numbers, material);
  material.name = name;
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
    const bool is_used = std::ranges::any_of(scene.bodies, [&material](const Body& body) {
      const auto* beam = std::get_if<BeamBody>(&body.shape);
      return beam != nullptr && beam->material == material.name;
    });
    if (is_used && !find_named(scene.materials, material.name)) scene.materials.push_back(material);
  }
}

void read_bodies(const JsonNode& node, Scene& scene, NumberReader& numbers) {
  const std::vector<std::string> materials = material_names(scene);
  read_each(node, [&](const std::string& name, const JsonNode& body) {
    if (name == ground_name) body.fail("has the name that is kept for the ground");
    scene.bodies.push_back(read_body(name, body, materials, numbers));
  });
  add_library_materials(scene);
}

/// @param bodies  by whose names joints find them
void read_joints(const JsonNode& node, const JsonNode& bodies, Scene& scene,
                 NumberReader& numbers) {
  std::vector<std::string> names = keys_of(bodies.value());
  names.emplace_back(ground_name);
  read_each(node, [&](const std::string& name, const JsonNode& joint) {
    scene.joints.push_back(read_joint(name, joint, names, numbers));
  });
}

void read_materials(const JsonNode& node, Scene& scene, NumberReader& numbers) {
  read_each(node, [&](const std::string& name, const JsonNode& material) {
    scene.materials.push_back(read_material(name, material, numbers));
  });
}

/// They look at bodies and joints.
void read_loads(const JsonNode& node, Scene& scene, NumberReader& numbers) {
  read_each(node, [&](const std::string& name, const JsonNode& load) {
    scene.loads.push_back(read_load(name, load, scene, numbers));
  });
}

void read_gravity(const JsonNode& node, Scene& scene, NumberReader& numbers) {
  scene.gravity = numbers.triple(node, quantities::acceleration);
  for (const Number& component : scene.gravity) {
    if (component.is_bound()) node.fail("cannot be bound to a design variable");
  }
}

}  // namespace

Scene read_scene(const JsonNode& node, NumberReader& numbers) {
  Scene scene;
  const auto read_with = [&](const char* key, const auto& read) {
    if (const auto member = node.find(key)) read(*member, scene, numbers);
  };
  MistakeCollector mistakes;
  mistakes.collect([&] {
    node.allow_keys({"gravity", "catalogue", "materials", "bodies", "joints", "loads"});
  });
  mistakes.collect([&] { read_with("gravity", read_gravity); });
  mistakes.collect([&] { read_with("materials", read_materials); });
  mistakes.fail_if_any();
  const JsonNode bodies = node.at("bodies");
  if (bodies.members().empty()) bodies.fail("has no body");
  mistakes.collect([&] { read_bodies(bodies, scene, numbers); });
  mistakes.collect([&] {
    if (const auto joints = node.find("joints")) read_joints(*joints, bodies, scene, numbers);
  });
  mistakes.fail_if_any();
  read_with("loads", read_loads);
  return scene;
}

}  // namespace pleuel
