#include "core/scene/reading/response_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "core/scene/joint_kind.hpp"
#include "core/scene/magnitude_direction.hpp"
#include "core/scene/reading/body_response_reader.hpp"
#include "core/scene/reading/expression_response_reader.hpp"
#include "core/scene/reading/joint_type.hpp"
#include "core/scene/reading/limits.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/response_kind.hpp"

namespace pleuel {
namespace {

// Responses with a history.

const Joint& read_joint_name(const JsonNode& node, const Scene& scene) {
  return *find_named(scene.joints, read_known_name(node, "joint", names_of(scene.joints)));
}

/// A drive of an angle has a torque, one of a displacement a force.
void check_effort(const JsonNode& name, const Joint& joint, ResponseType type) {
  const bool is_angle = joint.drive->coordinate == DrivenCoordinate::angle;
  if (type == ResponseType::drive_torque && !is_angle) {
    name.fail(fmt::format("names the joint \"{}\", whose drive has a drive-force", joint.name));
  }
  if (type == ResponseType::drive_force && is_angle) {
    name.fail(fmt::format("names the joint \"{}\", whose drive has a drive-torque", joint.name));
  }
}

void read_drive_effort(const JsonNode& node, const ResponseContext& context,
                       ResponseSettings& response) {
  allow_history_keys(node, {"joint"});
  const JsonNode name = node.at("joint");
  const Joint& joint = read_joint_name(name, context.scene);
  if (!joint.drive) {
    name.fail(fmt::format("names the joint \"{}\", which has no drive", joint.name));
  }
  check_effort(name, joint, response.type);
  response.joint = joint.name;
  read_history(node, context, response);
}

/// Position or velocity.
void read_joint_motion(const JsonNode& node, const ResponseContext& context,
                       ResponseSettings& response) {
  allow_history_keys(node, {"joint", "coordinate"});
  const JsonNode name = node.at("joint");
  const Joint& joint = read_joint_name(name, context.scene);
  check_coordinate_between_bodies(name, joint);
  response.joint = joint.name;
  response.coordinate = read_coordinate(node, joint);
  read_history(node, context, response);
}

/// The axis of a joint with the ground that a body slides or turns in.
std::array<double, 3> read_guide_axis(const JsonNode& node, const Scene& scene) {
  const Joint& joint = read_joint_name(node, scene);
  if (!kind_of(joint.type).has_axis() || joint.bodies[0] != ground_name) {
    node.fail(
        fmt::format("must name a joint with an axis and \"ground\" as its first body, but "
                    "\"{}\" is none",
                    joint.name));
  }
  const auto& [x, y, z] = joint.axis;
  const double length = std::hypot(x, y, z);
  return {x / length, y / length, z / length};
}

std::string read_turning_body(const JsonNode& node, const Scene& scene) {
  const Body& body = read_body_name(node, scene);
  if (std::holds_alternative<PointMass>(body.shape))
    node.fail("must not be a point mass, which does not turn");
  return body.name;
}

void read_transmission_angle(const JsonNode& node, const ResponseContext& context,
                             ResponseSettings& response) {
  const bool has_guide = node.find("joint").has_value();
  if (has_guide) {
    allow_history_keys(node, {"body", "joint"});
    response.bodies = {read_turning_body(node.at("body"), context.scene)};
    response.along = read_guide_axis(node.at("joint"), context.scene);
  } else {
    allow_history_keys(node, {"bodies"});
    for (const JsonNode& body : node.at("bodies").items(2)) {
      response.bodies.push_back(read_turning_body(body, context.scene));
    }
  }
  read_history(node, context, response);
}

const Load& read_load_name(const JsonNode& node, const Scene& scene) {
  return *find_named(scene.loads, read_known_name(node, "load", names_of(scene.loads)));
}

/// Length or force.
void read_spring_state(const JsonNode& node, const ResponseContext& context,
                       ResponseSettings& response) {
  allow_history_keys(node, {"load"});
  const JsonNode name = node.at("load");
  const Load& load = read_load_name(name, context.scene);
  if (!std::holds_alternative<SpringDamper>(load.element)) {
    name.fail(
        fmt::format("must name a load of the type \"spring\", but \"{}\" is none", load.name));
  }
  response.load = load.name;
  read_history(node, context, response);
}

void read_motor_power(const JsonNode& node, const ResponseContext& context,
                      ResponseSettings& response) {
  allow_history_keys(node, {"load"});
  const JsonNode name = node.at("load");
  const Load& load = read_load_name(name, context.scene);
  const auto* force = std::get_if<JointForce>(&load.element);
  if (force == nullptr || (!force->motor && !force->control)) {
    name.fail(
        fmt::format("must name a load with a motor in a joint, but \"{}\" has none", load.name));
  }
  response.load = load.name;
  read_history(node, context, response);
}

bool resists_rates(const std::optional<TimeFunction>& resistance, const Number& damping) {
  return resistance.has_value() || damping.is_bound() || damping.constant != 0.0;
}

void read_damper_power(const JsonNode& node, const ResponseContext& context,
                       ResponseSettings& response) {
  allow_history_keys(node, {"load"});
  const JsonNode name = node.at("load");
  const Load& load = read_load_name(name, context.scene);
  const auto* spring = std::get_if<SpringDamper>(&load.element);
  const auto* force = std::get_if<JointForce>(&load.element);
  const bool is_damper = (spring && resists_rates(spring->resistance, spring->damping)) ||
                         (force && resists_rates(force->resistance, force->damping));
  if (!is_damper) {
    name.fail(fmt::format(
        "must name a load with \"damping\" or \"resistance\", but \"{}\" has none", load.name));
  }
  response.load = load.name;
  read_history(node, context, response);
}

void read_reaction(const JsonNode& node, const ResponseContext& context,
                   ResponseSettings& response) {
  allow_history_keys(node, {"joint", "direction"});
  response.joint = read_joint_name(node.at("joint"), context.scene).name;
  response.direction = read_direction_or_magnitude(node.at("direction"));
  read_history(node, context, response);
}

/// Kinetic or elastic, of one body or of all.
void read_energy(const JsonNode& node, const ResponseContext& context, ResponseSettings& response) {
  allow_history_keys(node, {"body"});
  if (const auto body = node.find("body")) {
    const bool is_elastic = response.type == ResponseType::elastic_energy;
    if (is_elastic && find_imported(node, context.scene, response) == nullptr) {
      read_elastic_beam(node, context.scene, response);
    } else {
      response.bodies = {read_body_name(*body, context.scene).name};
    }
  }
  read_history(node, context, response);
}

void read_energy_balance(const JsonNode& node, const ResponseContext& context,
                         ResponseSettings& response) {
  node.allow_keys({"type", "from", "to", "over_time"});
  if (const auto over_time = node.find("over_time")) {
    over_time->fail("is not for an energy-balance, which compares two times");
  }
  response.over_time = OverTime::final;
  read_window(node, context, response);
}

void read_drift(const JsonNode& node, const ResponseContext& context, ResponseSettings& response) {
  allow_history_keys(node, {"level"});
  if (const auto level = node.find("level")) {
    response.level = read_choice<DriftLevel>(
        *level, {{"position", DriftLevel::position}, {"velocity", DriftLevel::velocity}});
  }
  read_history(node, context, response);
}

// Responses without.

void read_mass(const JsonNode& node, const Scene& scene, ResponseSettings& response) {
  node.allow_keys({"type", "body", "bodies", "over_time"});
  if (const auto over_time = node.find("over_time")) {
    over_time->fail("is not for a mass, which does not change in time");
  }
  const std::optional<JsonNode> one = node.find("body"), many = node.find("bodies");
  if (one && many) node.fail("has both \"body\" and \"bodies\"");
  if (one) response.bodies = {read_body_name(*one, scene).name};
  if (!many) return;
  for (const JsonNode& item : many->items()) {
    const std::string name = read_body_name(item, scene).name;
    if (std::find(response.bodies.begin(), response.bodies.end(), name) != response.bodies.end()) {
      item.fail(fmt::format("names the body \"{}\" a second time", name));
    }
    response.bodies.push_back(name);
  }
  if (response.bodies.empty()) many->fail("must name at least one body");
}

/// A component or a vector.
std::array<double, 3> read_axis(const JsonNode& node, const ResponseContext& context) {
  if (node.value().is_array()) return context.numbers.unit_vector(node);
  std::array<double, 3> axis{};
  axis[read_choice<std::size_t>(node, {{"x", 0}, {"y", 1}, {"z", 2}})] = 1.0;
  return axis;
}

void read_frequency(const JsonNode& node, const ResponseContext& context,
                    ResponseSettings& response) {
  const Scene& scene = context.scene;
  node.allow_keys({"type", "body", "mode", "direction", "over_time"});
  if (const auto over_time = node.find("over_time")) {
    over_time->fail("is not for a frequency, which does not change in time");
  }
  if (node.find("body") && find_imported(node, scene, response) == nullptr) {
    read_elastic_beam(node, scene, response);
  }
  if (const auto mode = node.find("mode")) {
    response.mode.number = mode->whole_number(1, most_modes) - 1;
  }
  if (const auto axis = node.find("direction")) response.mode.axis = read_axis(*axis, context);
}

void read_damped_mode(const JsonNode& node, const ResponseContext& context,
                      ResponseSettings& response) {
  const bool is_ratio = response.type == ResponseType::damping_ratio;
  if (const auto over_time = node.find("over_time")) {
    over_time->fail("is not for a number of a mode, which does not change in time");
  }
  if (is_ratio) {
    node.allow_keys({"type", "mode", "direction"});
  } else {
    node.allow_keys({"type", "direction"});
  }
  response.mode.of = is_ratio ? ModeNumber::damping_ratio : ModeNumber::growth_rate;
  const auto mode = node.find("mode");
  response.mode.number = mode ? mode->whole_number(1, most_modes) - 1 : ModeChoice::worst;
  if (const auto axis = node.find("direction")) response.mode.axis = read_axis(*axis, context);
}

/// Names of columns in files of histories (docs/reference/responses.md).
void check_column(const std::string& name, const JsonNode& node) {
  if (name == "time" || name.ends_with(":error")) {
    node.fail(
        "has a name that files of histories need for their own columns: \"time\" and \"…:error\"");
  }
}

/// A magnitude is no linear function of what changes: its rate is another number.
void refuse_rate_of_magnitude(const JsonNode& node, const ResponseSettings& response) {
  const auto direction = node.find("direction");
  if (!direction || response.direction != magnitude_direction || response.along) return;
  direction->fail_with_value(
      fmt::format("must be \"x\", \"y\", \"z\" or a vector, as the magnitude of "
                  "the {} is no rate of that of "
                  "the {}",
                  kind_of(response.type).word, kind_of(observed_type(response.type)).word));
}

ResponseSettings read_response(const std::string& name, const JsonNode& node,
                               const ResponseContext& context) {
  ResponseSettings response;
  response.name = name;
  response.type = read_kind(node.at("type"), response_kinds);
  switch (observed_type(response.type)) {
    case ResponseType::mass:
      read_mass(node, context.scene, response);
      break;
    case ResponseType::frequency:
      read_frequency(node, context, response);
      break;
    case ResponseType::damping_ratio:
    case ResponseType::growth_rate:
      read_damped_mode(node, context, response);
      break;
    case ResponseType::stress:
      read_stress(node, context, response);
      break;
    case ResponseType::shear_stress:
      read_shear_stress(node, context, response);
      break;
    case ResponseType::fatigue:
    case ResponseType::fatigue_damage:
      read_fatigue(node, context, response);
      break;
    case ResponseType::deflection:
      read_deflection(node, context, response);
      break;
    case ResponseType::buckling:
    case ResponseType::lateral_buckling:
      read_buckling(node, context, response);
      break;
    case ResponseType::position:
    case ResponseType::velocity:
    case ResponseType::acceleration:
      read_motion(node, context, response);
      break;
    case ResponseType::drive_torque:
    case ResponseType::drive_force:
    case ResponseType::drive_power:
      read_drive_effort(node, context, response);
      break;
    case ResponseType::reaction_force:
    case ResponseType::reaction_moment:
      read_reaction(node, context, response);
      break;
    case ResponseType::kinetic_energy:
    case ResponseType::elastic_energy:
      read_energy(node, context, response);
      break;
    case ResponseType::energy_balance:
      read_energy_balance(node, context, response);
      break;
    case ResponseType::constraint_drift:
      read_drift(node, context, response);
      break;
    case ResponseType::section_force:
      read_section_force(node, context, response);
      break;
    case ResponseType::angle:
    case ResponseType::angular_velocity:
    case ResponseType::angular_acceleration:
      read_turning(node, context, response);
      break;
    case ResponseType::joint_position:
    case ResponseType::joint_velocity:
      read_joint_motion(node, context, response);
      break;
    case ResponseType::transmission_angle:
      read_transmission_angle(node, context, response);
      break;
    case ResponseType::spring_length:
    case ResponseType::spring_force:
      read_spring_state(node, context, response);
      break;
    case ResponseType::motor_power:
      read_motor_power(node, context, response);
      break;
    case ResponseType::damper_power:
      read_damper_power(node, context, response);
      break;
    case ResponseType::jerk:  // read as what they are the rates of
    case ResponseType::angular_jerk:
    case ResponseType::joint_acceleration:
    case ResponseType::expression:  // once all others are read
      break;
  }
  if (kind_of(response.type).rate_of) refuse_rate_of_magnitude(node, response);
  return response;
}

}  // namespace

std::vector<ResponseSettings> read_responses(const JsonNode& node, const ResponseContext& context) {
  std::vector<ResponseSettings> responses;
  read_each(node, [&](const std::string& name, const JsonNode& response) {
    check_column(name, response);
    responses.push_back(read_response(name, response, context));
  });
  MistakeCollector mistakes;
  for (ResponseSettings& response : responses) {
    if (response.type != ResponseType::expression) continue;
    mistakes.collect([&] {
      response = read_expression_response(response.name, node.at(response.name), responses,
                                          context.numbers);
    });
  }
  mistakes.fail_if_any();
  return responses;
}

}  // namespace pleuel
