#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/scene/joint_kind.hpp"
#include "core/scene/reading/joint_type.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/time_function_reader.hpp"
#include "core/scene/visit_numbers.hpp"

namespace pleuel {
namespace {

/// Cosine of the angle between axes that are meant to be normal to each other: rounding.
constexpr double normal_tolerance = 1e-9;

std::vector<std::string_view> keys_of(JointType type) {
  std::vector<std::string_view> words = {"type", "bodies", "at"};
  for (const JointKey& key : joint_keys) {
    if (key.is_of(kind_of(type))) words.push_back(key.word);
  }
  words.push_back("drive");
  return words;
}

[[noreturn]] void fail_key_of_others(const JsonNode& node, const JointKey& key, JointType type) {
  std::vector<std::string_view> owners;
  for (const JointKind& kind : joint_kinds) {
    if (key.is_of(kind)) owners.push_back(kind.word);
  }
  if (owners.size() == 1) node.fail(fmt::format("is for {} joints only", owners.front()));
  node.fail(fmt::format("is not for a {} joint, which has no {}", name_of(type), key.word));
}

void refuse_keys_of_others(const JsonNode& node, JointType type) {
  for (const JointKey& key : joint_keys) {
    if (key.is_of(kind_of(type))) continue;
    if (const auto found = node.find(std::string(key.word))) fail_key_of_others(*found, key, type);
  }
}

/// A direction of sliding has no sensible default; the axis of rotation of a planar mechanism has.
void read_axis(const JsonNode& node, Joint& joint, const NumberReader& numbers) {
  const JointKind& kind = kind_of(joint.type);
  if (!kind.has_axis() || (kind.only_turns_about_axis() && !node.find("axis"))) return;
  joint.axis = numbers.direction(node.at("axis"));
}

void read_second_axis(const JsonNode& node, Joint& joint, const NumberReader& numbers) {
  if (!kind_of(joint.type).has_second_axis()) return;
  const JsonNode second = node.at("second_axis");
  joint.second_axis = numbers.direction(second);
  const std::array<double, 3> a = numbers.unit_vector(node.at("axis"));
  const std::array<double, 3> b = numbers.unit_vector(second);
  if (std::abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) > normal_tolerance) {
    second.fail_with_value("must be normal to \"axis\"");
  }
}

void read_second_point(const JsonNode& node, Joint& joint, NumberReader& numbers) {
  if (!kind_of(joint.type).has_length()) return;
  joint.to = numbers.triple(node.at("to"), quantities::length);
}

Drive read_drive(const JsonNode& node, const Joint& joint, NumberReader& numbers) {
  check_drivable(node, joint);
  const DrivenCoordinate coordinate = read_coordinate(node, joint);
  return {read_drive_function(node, driven_quantity(coordinate), numbers), coordinate};
}

}  // namespace

std::array<std::string, 2> read_pair(const JsonNode& node, const std::vector<std::string>& bodies) {
  const std::vector<JsonNode> items = node.items(2);
  const std::string first = read_known_name(items[0], "body", bodies);
  const std::string second = read_known_name(items[1], "body", bodies);
  if (first == second) node.fail(fmt::format("must name two bodies, got \"{}\" twice", first));
  return {first, second};
}

Joint read_joint(const std::string& name, const JsonNode& node,
                 const std::vector<std::string>& bodies, NumberReader& numbers) {
  Joint joint;
  joint.name = name;
  joint.type = read_joint_type(node.at("type"));
  refuse_keys_of_others(node, joint.type);
  node.allow_keys(keys_of(joint.type));
  joint.bodies = read_pair(node.at("bodies"), bodies);
  joint.at = numbers.triple(node.at("at"), quantities::length);
  read_second_point(node, joint, numbers);
  read_axis(node, joint, numbers);
  read_second_axis(node, joint, numbers);
  if (const auto drive = node.find("drive")) joint.drive = read_drive(*drive, joint, numbers);
  return joint;
}

}  // namespace pleuel
