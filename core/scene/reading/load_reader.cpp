#include <functional>

#include <fmt/format.h>

#include "core/scene/reading/joint_reader.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/time_function_reader.hpp"

namespace pleuel {
namespace {

const Body& read_loaded_body(const JsonNode& node, const Scene& scene) {
  if (node.value() == ground_name) node.fail_with_value("must name a body that can move");
  return *find_named(scene.bodies, read_known_name(node, "body", names_of(scene.bodies)));
}

const Joint& read_loaded_joint(const JsonNode& node, const Scene& scene) {
  const std::string name = read_known_name(node, "joint", names_of(scene.joints));
  const Joint& joint = *find_named(scene.joints, name);
  check_coordinate_between_bodies(node, joint);
  return joint;
}

/// What a law along the coordinate of a joint may be a function of.
StateNames names_along(DrivenCoordinate coordinate) {
  const AlongCoordinate measures = along(coordinate);
  if (coordinate == DrivenCoordinate::angle) {
    return {"angle", "angles", measures.coordinate, measures.rate};
  }
  return {"displacement", "displacements", measures.coordinate, measures.rate};
}

/// A function of time; where it names a joint, of its coordinate, too.
TimeFunction read_value(const JsonNode& node, const Quantity& quantity, const Scene& scene,
                        NumberReader& numbers, std::optional<JointCoordinate>& over) {
  LawSource source{node, quantity};
  if (!node.value().is_object() || !node.find("joint")) return read_load_function(source, numbers);
  const Joint& joint = read_loaded_joint(node.at("joint"), scene);
  over = JointCoordinate{joint.name, read_coordinate(node, joint)};
  source.state = names_along(over->coordinate);
  source.other_keys = {"joint", "coordinate"};
  TimeFunction function = read_load_function(source, numbers);
  if (!depends_on_state(function)) {
    node.fail(fmt::format("names a joint, but is no function of its {} or speed",
                          source.state->coordinate));
  }
  return function;
}

template <LoadKind kind>
PointLoad read_point_load(const JsonNode& node, const Scene& scene, NumberReader& numbers) {
  PointLoad load{kind};
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, load); }, {"type"});
  const Body& body = read_loaded_body(node.at("body"), scene);
  load.body = body.name;
  load.value =
      read_value(node.at("value"), load.is_force() ? quantities::force : quantities::torque, scene,
                 numbers, load.over);
  if (load.to && std::holds_alternative<ImportedBody>(body.shape)) {
    node.at("to").fail(fmt::format(
        "does not work with the body \"{}\": of a body from a file only places are known",
        body.name));
  }
  if (!load.is_force() && std::holds_alternative<PointMass>(body.shape)) {
    node.at("body").fail(
        fmt::format("must name a body that can turn, but \"{}\" is a point mass", body.name));
  }
  return load;
}

SpringDamper read_spring(const JsonNode& node, const Scene& scene, NumberReader& numbers) {
  SpringDamper spring;
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, spring); }, {"type"});
  std::vector<std::string> bodies = names_of(scene.bodies);
  bodies.emplace_back(ground_name);
  spring.bodies = read_pair(node.at("bodies"), bodies);
  const std::vector<JsonNode> places = node.at("at").items(2);
  for (std::size_t end : {0U, 1U}) {
    spring.at[end] = numbers.triple(places[end], quantities::length);
  }
  if (const auto resistance = node.find("resistance")) {
    const StateNames names{"elongation", "elongations", quantities::length, quantities::speed};
    spring.resistance =
        read_resistance({*resistance, quantities::force, LawPurpose::load, names}, numbers);
  }
  return spring;
}

/// A motor that follows a motion.
MotorControl read_control(const JsonNode& node, DrivenCoordinate coordinate,
                          NumberReader& numbers) {
  const AlongCoordinate measures = along(coordinate);
  MotorControl control;
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, control, measures); }, {"type"});
  control.target = read_target(node.at("target"), measures.coordinate, numbers);
  return control;
}

void read_motor(const JsonNode& node, const Joint& joint, NumberReader& numbers,
                JointForce& force) {
  if (is_driven(joint, force.coordinate)) {
    node.fail(fmt::format("would have no effect: the joint \"{}\" is driven", joint.name));
  }
  const bool has_type = node.value().is_object() && node.find("type");
  if (has_type && node.at("type").value() == "control") {
    force.control = read_control(node, force.coordinate, numbers);
    return;
  }
  force.motor = read_load_function(
      {node, along(force.coordinate).force, LawPurpose::load, names_along(force.coordinate)},
      numbers);
}

JointForce read_joint_force(const JsonNode& node, const Scene& scene, NumberReader& numbers) {
  const Joint& joint = read_loaded_joint(node.at("joint"), scene);
  JointForce force;
  force.joint = joint.name;
  force.coordinate = read_coordinate(node, joint);
  const AlongCoordinate measures = along(force.coordinate);
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, force, measures); }, {"type"});
  const auto motor = node.find("motor"), resistance = node.find("resistance");
  if (resistance) {
    force.resistance = read_resistance(
        {*resistance, measures.force, LawPurpose::load, names_along(force.coordinate)}, numbers);
  }
  if (motor) read_motor(*motor, joint, numbers, force);
  return force;
}

}  // namespace

Load read_load(const std::string& name, const JsonNode& node, const Scene& scene,
               NumberReader& numbers) {
  using Element = decltype(Load::element);
  using Read = std::function<Element(const JsonNode&, const Scene&, NumberReader&)>;
  static const Choice<Read> elements[] = {{"force", read_point_load<LoadKind::force>},
                                          {"torque", read_point_load<LoadKind::torque>},
                                          {"spring", read_spring},
                                          {"joint", read_joint_force}};
  return {name, read_choice(node.at("type"), elements)(node, scene, numbers)};
}

}  // namespace pleuel
