#include <fmt/format.h>

#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

enum class DriveType { constant_speed, ramp_to_speed };

Drive read_drive(const JsonNode& node, NumberReader& numbers) {
  const auto type = read_choice<DriveType>(
      node.at("type"),
      {{"constant-speed", DriveType::constant_speed}, {"ramp-to-speed", DriveType::ramp_to_speed}});
  if (type == DriveType::constant_speed) {
    node.allow_keys({"type", "speed"});
    return ConstantSpeedDrive{numbers.designable(node.at("speed"), quantities::angular_speed)};
  }
  node.allow_keys({"type", "speed", "ramp"});
  RampToSpeedDrive drive;
  drive.speed = numbers.designable(node.at("speed"), quantities::angular_speed);
  drive.ramp = numbers.designable(node.at("ramp"), quantities::time, Range::positive);
  return drive;
}

std::array<std::string, 2> read_pair(const JsonNode& node, const std::vector<std::string>& bodies) {
  const std::vector<JsonNode> items = node.items(2);
  const std::string first = read_known_name(items[0], "body", bodies);
  const std::string second = read_known_name(items[1], "body", bodies);
  if (first == second) node.fail(fmt::format("must name two bodies, got \"{}\" twice", first));
  return {first, second};
}

/// A direction of sliding has no sensible default; the axis of rotation of a planar mechanism has.
void read_axis(const JsonNode& node, Joint& joint, const NumberReader& numbers) {
  const std::optional<JsonNode> axis = node.find("axis");
  if (joint.type == JointType::fixed) {
    if (axis) axis->fail("is not for a fixed joint, which has no axis");
    return;
  }
  if (!axis && joint.type == JointType::revolute) return;
  joint.axis = numbers.direction(node.at("axis"));
}

}  // namespace

Joint read_joint(const std::string& name, const JsonNode& node,
                 const std::vector<std::string>& bodies, NumberReader& numbers) {
  node.allow_keys({"type", "bodies", "at", "axis", "drive"});
  Joint joint;
  joint.name = name;
  joint.type =
      read_choice<JointType>(node.at("type"), {{"revolute", JointType::revolute},
                                               {"prismatic", JointType::prismatic},
                                               {"fixed", JointType::fixed},
                                               {"point-on-line", JointType::point_on_line}});
  joint.bodies = read_pair(node.at("bodies"), bodies);
  joint.at = numbers.triple(node.at("at"), quantities::length);
  read_axis(node, joint, numbers);
  if (const auto drive = node.find("drive")) {
    if (joint.type != JointType::revolute) {
      drive->fail(fmt::format("needs a revolute joint, but \"{}\" is of the type {}", name,
                              node.at("type").value().dump()));
    }
    joint.drive = read_drive(*drive, numbers);
  }
  return joint;
}

}  // namespace pleuel
