#include <fmt/format.h>

#include "core/scene/grammar/tables.hpp"
#include "core/scene/joint_kind.hpp"

namespace pleuel {

namespace {

std::string refusal(const JointKey& key, const JointKind& kind) {
  std::vector<std::string_view> owners;
  for (const JointKind& other : joint_kinds) {
    if (key.is_of(other)) owners.push_back(other.word);
  }
  if (owners.size() == 1) return fmt::format("is for {} joints only", owners.front());
  return fmt::format("is not for a {} joint, which has no {}", kind.word, key.word);
}

const char* drive_definition(const JointKind& kind) {
  const bool has_displacement = kind.has_displacement() || kind.has_length();
  if (kind.has_angle() && has_displacement) return "drive_of_one";
  return kind.has_angle() || has_displacement ? "drive" : "nothing";
}

}  // namespace

void describe(Keys& keys, Joint& s) {
  const JointKind& kind = kind_of(s.type);
  for (const JointKey& key : joint_keys) {
    if (!key.is_of(kind)) keys.refused(key.word.data(), refusal(key, kind));
  }
  keys.other("bodies", "two_bodies", "");
  keys.point("at", s.at, quantities::length,
             kind.has_length() ? "The point of the first body at the start {}."
                               : "Where the joint is at the start {}.");
  if (kind.has_length()) {
    keys.point("to", s.to, quantities::length, "The point of the second body {}.");
  }
  // A direction of sliding has no sensible default; the axis of rotation of a planar mechanism has.
  if (kind.only_turns_about_axis()) {
    keys.direction(optional_key("axis"), s.axis, "Of rotation; default z.");
  } else if (kind.has_axis()) {
    keys.direction("axis", s.axis,
                   kind.has_second_axis()    ? "Fixed in the first body."
                   : kind.has_displacement() ? "Of sliding."
                                             : "Normal of the plane.");
  }
  if (kind.has_second_axis()) {
    keys.direction("second_axis", s.second_axis, "Fixed in the second body, normal to \"axis\".");
  }
  keys.other(optional_key("drive"), drive_definition(kind), "");
}

}  // namespace pleuel
