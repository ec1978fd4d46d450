#include "core/scene/reading/scene_reader.hpp"

#include <algorithm>

#include "core/scene/material_library.hpp"
#include "core/scene/reading/mistakes.hpp"

namespace pleuel {
namespace {

/// Those of the scene and those of the library that it does not replace.
std::vector<std::string> material_names(const Scene& scene) {
  std::vector<std::string> names = names_of(scene.materials);
  for (const Material& material : material_library()) {
    if (!find_named(scene.materials, material.name)) names.push_back(material.name);
  }
  return names;
}

void read_bodies(const JsonNode& node, Scene& scene, NumberReader& numbers) {
  const std::vector<std::string> materials = material_names(scene);
  read_each(node, [&](const std::string& name, const JsonNode& body) {
    if (name == ground_name) body.fail("has the name that is kept for the ground");
    scene.bodies.push_back(read_body(name, body, materials, numbers));
  });
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
    read_keys(material, numbers, scene.materials.emplace_back(Material{name, {}, {}, {}}));
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
