#include <algorithm>

#include <fmt/format.h>

#include "core/scene/reading/joint_type.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/time_function_reader.hpp"
#include "core/scene/visit_numbers.hpp"

namespace pleuel {
namespace {

enum class LoadType { force, torque, spring, joint };

const Body& read_loaded_body(const JsonNode& node, const Scene& scene) {
  if (node.value() == ground_name) node.fail_with_value("must name a body that can move");
  return *find_named(scene.bodies, read_known_name(node, "body", names_of(scene.bodies)));
}

/// What forces and torques have in common.
template <class PointLoad>
PointLoad read_point_load(const JsonNode& node, const Quantity& quantity, const Scene& scene,
                          NumberReader& numbers) {
  node.allow_keys({"type", "body", "at", "direction", "value", "follows"});
  PointLoad load;
  load.body = read_loaded_body(node.at("body"), scene).name;
  load.at = numbers.triple(node.at("at"), quantities::length);
  load.direction = numbers.unit_vector(node.at("direction"));
  load.value = read_load_function(node.at("value"), quantity, numbers);
  if (const auto follows = node.find("follows")) load.follows_body = follows->truth();
  return load;
}

PointTorque read_torque(const JsonNode& node, const Scene& scene, NumberReader& numbers) {
  auto torque = read_point_load<PointTorque>(node, quantities::torque, scene, numbers);
  if (std::holds_alternative<PointMass>(find_named(scene.bodies, torque.body)->shape)) {
    node.at("body").fail(
        fmt::format("must name a body that can turn, but \"{}\" is a point mass", torque.body));
  }
  return torque;
}

SpringDamper read_spring(const JsonNode& node, const Scene& scene, NumberReader& numbers) {
  node.allow_keys({"type", "bodies", "at", "stiffness", "damping", "free_length"});
  std::vector<std::string> bodies = names_of(scene.bodies);
  bodies.emplace_back(ground_name);
  SpringDamper spring;
  spring.bodies = read_pair(node.at("bodies"), bodies);
  const std::vector<JsonNode> places = node.at("at").items(2);
  for (std::size_t end : {0U, 1U}) {
    spring.at[end] = numbers.triple(places[end], quantities::length);
  }
  spring.stiffness =
      numbers.designable(node.at("stiffness"), quantities::spring_stiffness, Range::not_negative);
  if (const auto damping = node.find("damping")) {
    spring.damping =
        numbers.designable(*damping, quantities::damping_constant, Range::not_negative);
  }
  if (const auto length = node.find("free_length")) {
    spring.free_length = numbers.designable(*length, quantities::length, Range::not_negative);
  }
  return spring;
}

const Joint& read_loaded_joint(const JsonNode& node, const Scene& scene) {
  const std::string name = read_known_name(node, "joint", names_of(scene.joints));
  const Joint& joint = *find_named(scene.joints, name);
  std::vector<JointType> types = drivable_types();
  types.erase(std::remove(types.begin(), types.end(), JointType::distance), types.end());
  if (std::find(types.begin(), types.end(), joint.type) == types.end()) {
    fail_joint_type(node, joint, types);
  }
  return joint;
}

TimeFunction read_motor(const JsonNode& node, const Joint& joint, DrivenCoordinate coordinate,
                        NumberReader& numbers) {
  if (joint.drive && joint.drive->coordinate == coordinate) {
    node.fail(fmt::format("would have no effect: the joint \"{}\" is driven", joint.name));
  }
  const bool is_angle = coordinate == DrivenCoordinate::angle;
  return read_load_function(node, is_angle ? quantities::torque : quantities::force, numbers);
}

JointForce read_joint_force(const JsonNode& node, const Scene& scene, NumberReader& numbers) {
  node.allow_keys({"type", "joint", "coordinate", "stiffness", "damping", "rest", "motor"});
  const auto stiffness = node.find("stiffness"), damping = node.find("damping"),
             rest = node.find("rest"), motor = node.find("motor");
  if (!stiffness && !damping && !motor) {
    node.fail("does nothing; it needs \"stiffness\", \"damping\" or \"motor\"");
  }
  if (rest && !stiffness) rest->fail("is the rest position of a spring, and needs \"stiffness\"");
  const Joint& joint = read_loaded_joint(node.at("joint"), scene);
  JointForce force;
  force.joint = joint.name;
  force.coordinate = read_coordinate(node, joint);
  const bool is_angle = force.coordinate == DrivenCoordinate::angle;
  if (stiffness) {
    force.stiffness = numbers.designable(
        *stiffness, is_angle ? quantities::torsional_stiffness : quantities::spring_stiffness,
        Range::not_negative);
  }
  if (damping) {
    force.damping = numbers.designable(
        *damping, is_angle ? quantities::torsional_damping : quantities::damping_constant,
        Range::not_negative);
  }
  if (rest) force.rest = numbers.designable(*rest, driven_quantity(force.coordinate));
  if (motor) force.motor = read_motor(*motor, joint, force.coordinate, numbers);
  return force;
}

}  // namespace

Load read_load(const std::string& name, const JsonNode& node, const Scene& scene,
               NumberReader& numbers) {
  const auto type = read_choice<LoadType>(node.at("type"), {{"force", LoadType::force},
                                                            {"torque", LoadType::torque},
                                                            {"spring", LoadType::spring},
                                                            {"joint", LoadType::joint}});
  switch (type) {
    case LoadType::force:
      return {name, read_point_load<PointForce>(node, quantities::force, scene, numbers)};
    case LoadType::torque:
      return {name, read_torque(node, scene, numbers)};
    case LoadType::spring:
      return {name, read_spring(node, scene, numbers)};
    case LoadType::joint:
      break;
  }
  return {name, read_joint_force(node, scene, numbers)};
}

}  // namespace pleuel
