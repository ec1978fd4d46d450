#include "core/scene/reading/joint_type.hpp"

#include <fmt/format.h>

#include "core/scene/reading/suggestion.hpp"

namespace pleuel {
namespace {

constexpr Choice<JointType> joint_types[] = {{"revolute", JointType::revolute},
                                             {"prismatic", JointType::prismatic},
                                             {"fixed", JointType::fixed},
                                             {"point-on-line", JointType::point_on_line},
                                             {"cylindrical", JointType::cylindrical},
                                             {"universal", JointType::universal},
                                             {"spherical", JointType::spherical},
                                             {"planar", JointType::planar},
                                             {"distance", JointType::distance}};

constexpr Choice<DrivenCoordinate> coordinates[] = {
    {"angle", DrivenCoordinate::angle}, {"displacement", DrivenCoordinate::displacement}};

}  // namespace

JointType read_joint_type(const JsonNode& node) {
  return read_choice(node, joint_types);
}

std::string name_of(JointType type) {
  return word_of(joint_types, type);
}

std::vector<DrivenCoordinate> drivable_coordinates(JointType type) {
  switch (type) {
    case JointType::revolute:
    case JointType::universal:
    case JointType::planar:
      return {DrivenCoordinate::angle};
    case JointType::prismatic:
    case JointType::point_on_line:
    case JointType::distance:
      return {DrivenCoordinate::displacement};
    case JointType::cylindrical:
      return {DrivenCoordinate::angle, DrivenCoordinate::displacement};
    case JointType::fixed:
    case JointType::spherical:
      break;
  }
  return {};
}

DrivenCoordinate read_coordinate(const JsonNode& node, const Joint& joint) {
  const std::vector<DrivenCoordinate> possible = drivable_coordinates(joint.type);
  const std::optional<JsonNode> key = node.find("coordinate");
  if (!key && possible.size() == 1) return possible.front();
  const JsonNode coordinate = node.at("coordinate");
  const auto chosen = read_choice(coordinate, coordinates);
  if (possible.size() == 1 && chosen != possible.front()) {
    coordinate.fail_with_value(fmt::format("must be \"{}\" for a joint of the type \"{}\"",
                                           word_of(coordinates, possible.front()),
                                           name_of(joint.type)));
  }
  return chosen;
}

void fail_joint_type(const JsonNode& node, const Joint& joint,
                     const std::vector<JointType>& needed) {
  std::vector<std::string> names;
  for (const JointType type : needed) names.push_back(name_of(type));
  node.fail(fmt::format("needs a joint of the type {}, but \"{}\" is of the type \"{}\"",
                        quoted_list(names, "or"), joint.name, name_of(joint.type)));
}

std::vector<JointType> drivable_types() {
  std::vector<JointType> types;
  for (const auto& [word, type] : joint_types) {
    if (!drivable_coordinates(type).empty()) types.push_back(type);
  }
  return types;
}

}  // namespace pleuel
