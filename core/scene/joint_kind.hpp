#pragma once

#include <cstddef>
#include <string_view>

#include "core/scene/kind_table.hpp"
#include "core/scene/scene.hpp"

/// What each type of joint leaves of the motion of the second body against the first. The equations
/// of a joint, its axes, coordinates, freedoms and words follow from one row of a table.
namespace pleuel {

/// Rotations that are left; as many as the number says.
enum class JointTurns { none = 0, about_axis = 1, about_both_axes = 2, all = 3 };

/// Displacements of the second body's point that are left.
enum class JointSlides {
  none,
  along_axis,
  across_axis,  ///< in the plane normal to the axis
  at_distance   ///< on a sphere about the point of the first body
};

struct JointKind {
  JointType type;
  std::string_view word;  ///< in a problem file
  JointTurns turns;
  JointSlides slides;
  std::string_view freedom;  ///< of the second body, in words

  /// Degrees of freedom in space, without a drive.
  constexpr int freedoms() const {
    const int displacements = slides == JointSlides::none         ? 0
                              : slides == JointSlides::along_axis ? 1
                                                                  : 2;
    return static_cast<int>(turns) + displacements;
  }
  /// Whether there is an angle about the axis.
  constexpr bool has_angle() const {
    return turns == JointTurns::about_axis || turns == JointTurns::about_both_axes;
  }
  /// Whether there is a displacement along the axis.
  constexpr bool has_displacement() const { return slides == JointSlides::along_axis; }
  /// Whether it holds a length between two points, which a drive can change.
  constexpr bool has_length() const { return slides == JointSlides::at_distance; }
  constexpr bool has_axis() const {
    return has_angle() || has_displacement() || slides == JointSlides::across_axis;
  }
  constexpr bool has_second_axis() const { return turns == JointTurns::about_both_axes; }
  constexpr bool only_turns_about_axis() const {
    return turns == JointTurns::about_axis && slides == JointSlides::none;
  }
  /// Whether the second body slides along the axis and keeps the direction of the axis.
  constexpr bool is_guide() const {
    return has_displacement() && (turns == JointTurns::none || turns == JointTurns::about_axis);
  }
};

/// In the order of JointType.
inline constexpr JointKind joint_kinds[] = {
    {JointType::revolute, "revolute", JointTurns::about_axis, JointSlides::none,
     "turns about the axis"},
    {JointType::prismatic, "prismatic", JointTurns::none, JointSlides::along_axis,
     "slides along the axis"},
    {JointType::fixed, "fixed", JointTurns::none, JointSlides::none, "does not move"},
    {JointType::point_on_line, "point-on-line", JointTurns::all, JointSlides::along_axis,
     "its point stays on the line"},
    {JointType::cylindrical, "cylindrical", JointTurns::about_axis, JointSlides::along_axis,
     "slides along the axis and turns about it"},
    {JointType::universal, "universal", JointTurns::about_both_axes, JointSlides::none,
     "turns about two axes"},
    {JointType::spherical, "spherical", JointTurns::all, JointSlides::none, "turns freely"},
    {JointType::planar, "planar", JointTurns::about_axis, JointSlides::across_axis,
     "slides in a plane and turns in it"},
    {JointType::distance, "distance", JointTurns::all, JointSlides::at_distance,
     "keeps its distance"},
    {JointType::point_on_plane, "point-on-plane", JointTurns::all, JointSlides::across_axis,
     "its point stays in the plane"},
};

static_assert(are_in_order(joint_kinds));

constexpr const JointKind& kind_of(JointType type) {
  return joint_kinds[static_cast<std::size_t>(type)];
}

/// A key in a problem file that only some types of joints have.
struct JointKey {
  std::string_view word;
  bool (JointKind::*is_had)() const;

  constexpr bool is_of(const JointKind& kind) const { return (kind.*is_had)(); }
};

inline constexpr JointKey joint_keys[] = {
    {"to", &JointKind::has_length},
    {"axis", &JointKind::has_axis},
    {"second_axis", &JointKind::has_second_axis},
};

/// Whether the drive of a joint prescribes this coordinate.
inline bool is_driven(const Joint& joint, DrivenCoordinate coordinate) {
  return joint.drive && joint.drive->coordinate == coordinate;
}

/// Where a joint holds its second body: apart from the first one only if it has a length.
inline const Point& second_point(const Joint& joint) {
  return kind_of(joint.type).has_length() ? joint.to : joint.at;
}

}  // namespace pleuel
