#include "core/scene/reading/joint_type.hpp"

#include <fmt/format.h>

#include "core/scene/reading/suggestion.hpp"

namespace pleuel {
namespace {

constexpr Choice<DrivenCoordinate> coordinates[] = {
    {"angle", DrivenCoordinate::angle}, {"displacement", DrivenCoordinate::displacement}};

}  // namespace

std::string name_of(JointType type) {
  return std::string(kind_of(type).word);
}

std::vector<DrivenCoordinate> drivable_coordinates(JointType type) {
  const JointKind& kind = kind_of(type);
  std::vector<DrivenCoordinate> all;
  if (kind.has_angle()) all.push_back(DrivenCoordinate::angle);
  if (kind.has_displacement() || kind.has_length()) all.push_back(DrivenCoordinate::displacement);
  return all;
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

namespace {

/// @throws InputError unless joints of this type have what is needed
template <class Predicate>
void require(const JsonNode& node, const Joint& joint, const Predicate& has_it) {
  if (has_it(kind_of(joint.type))) return;
  std::vector<std::string> names;
  for (const JointKind& kind : joint_kinds) {
    if (has_it(kind)) names.emplace_back(kind.word);
  }
  node.fail(fmt::format("needs a joint of the type {}, but \"{}\" is of the type \"{}\"",
                        quoted_list(names, "or"), joint.name, name_of(joint.type)));
}

}  // namespace

void check_drivable(const JsonNode& node, const Joint& joint) {
  require(node, joint,
          [](const JointKind& kind) { return !drivable_coordinates(kind.type).empty(); });
}

void check_coordinate_between_bodies(const JsonNode& node, const Joint& joint) {
  require(node, joint,
          [](const JointKind& kind) { return kind.has_angle() || kind.has_displacement(); });
}

}  // namespace pleuel
