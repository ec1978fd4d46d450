#include "core/scene/reading/joint_reader.hpp"

#include <fmt/format.h>

#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/suggestion.hpp"
#include "core/scene/reading/time_function_reader.hpp"

namespace pleuel {

namespace {

/// Those of a joint that a drive can prescribe: none, one, or for a cylindrical joint two.
std::vector<DrivenCoordinate> drivable_coordinates(const JointKind& kind) {
  std::vector<DrivenCoordinate> all;
  if (kind.has_angle()) all.push_back(DrivenCoordinate::angle);
  if (kind.has_displacement() || kind.has_length()) all.push_back(DrivenCoordinate::displacement);
  return all;
}

/// @throws InputError unless joints of this type have what is needed
template <class Predicate>
void require(const JsonNode& node, const Joint& joint, const Predicate& has_it) {
  if (has_it(kind_of(joint.type))) return;
  std::vector<std::string> names;
  for (const JointKind& kind : joint_kinds) {
    if (has_it(kind)) names.emplace_back(kind.word);
  }
  node.fail(fmt::format("needs a joint of the type {}, but \"{}\" is of the type \"{}\"",
                        quoted_list(names, "or"), joint.name, kind_of(joint.type).word));
}

Drive read_drive(const JsonNode& node, const Joint& joint, NumberReader& numbers) {
  require(node, joint, [](const JointKind& kind) { return !drivable_coordinates(kind).empty(); });
  const DrivenCoordinate coordinate = read_coordinate(node, joint);
  return {read_drive_function(node, along(coordinate).coordinate, numbers), coordinate};
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
  joint.type = read_row(node.at("type"), joint_kinds).type;
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, joint); }, {"type"});
  joint.bodies = read_pair(node.at("bodies"), bodies);
  if (const auto drive = node.find("drive")) joint.drive = read_drive(*drive, joint, numbers);
  return joint;
}

namespace {

constexpr Choice<DrivenCoordinate> coordinates[] = {
    {"angle", DrivenCoordinate::angle}, {"displacement", DrivenCoordinate::displacement}};

}  // namespace

DrivenCoordinate read_coordinate(const JsonNode& node, const Joint& joint) {
  const std::vector<DrivenCoordinate> possible = drivable_coordinates(kind_of(joint.type));
  const std::optional<JsonNode> key = node.find("coordinate");
  if (!key && possible.size() == 1) return possible.front();
  const JsonNode coordinate = node.at("coordinate");
  const auto chosen = read_choice(coordinate, coordinates);
  if (possible.size() == 1 && chosen != possible.front()) {
    coordinate.fail_with_value(fmt::format("must be \"{}\" for a joint of the type \"{}\"",
                                           word_of(coordinates, possible.front()),
                                           kind_of(joint.type).word));
  }
  return chosen;
}

void check_coordinate_between_bodies(const JsonNode& node, const Joint& joint) {
  require(node, joint,
          [](const JointKind& kind) { return kind.has_angle() || kind.has_displacement(); });
}

}  // namespace pleuel
