#include <cmath>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/scene/grammar/response_keys.hpp"
#include "core/scene/joint_kind.hpp"

namespace pleuel::response_tables {

void describe(Keys& keys, PointMotionResponse& motion, R& r, const Scope& scope) {
  keys.about(
      "Of a point of a body: a coordinate of its position [m], its velocity [m/s], acceleration "
      "[m/s^2] or jerk [m/s^3], the rate of the acceleration.");
  const Body* one = body(keys, "body", motion.point.body, scope);
  const bool has_places = one == nullptr || shape_of<BeamBody>(one) != nullptr ||
                          shape_of<ImportedBody>(one) != nullptr;
  const char* sentence = "For beams, from 0 to 1, and for imported bodies, a name; only for them.";
  if (one == nullptr) {
    keys.other(optional_key("at"), "named_place", sentence);
  } else if (has_places) {
    place(keys, one, motion.point, sentence);
  } else {
    keys.refused("at", fmt::format("is for beams only, but \"{}\" is none", one->name));
  }
  const char* direction = "Global axis, or the component along a vector (of any length).";
  if (motion.derivative == TimeDerivative::third) {
    component_of_jerk(keys, motion.component, "", direction);
  } else if (motion.derivative == TimeDerivative::none) {
    component(keys, motion.component, axes, direction);
  } else {
    component(keys, motion.component, axes_or_magnitude,
              "Global axis, the length of the vector, or its component along a vector (of any "
              "length).");
  }
  history(keys, r, scope);
}

void describe(Keys& keys, TurningResponse& turning, R& r, const Scope& scope) {
  keys.about(
      "Of a body frame, global axes: its angle [rad] about an axis, angular velocity [rad/s], "
      "angular acceleration [rad/s^2] or angular jerk [rad/s^3], the rate of the acceleration.");
  const Body* one = body(keys, "body", turning.body, scope);
  if (one != nullptr) {
    keys.must("body", shape_of<PointMass>(one) == nullptr,
              fmt::format("must name a body that can turn, but \"{}\" is a point mass", one->name));
  }
  if (turning.derivative == TimeDerivative::none) {
    keys.choice("direction", turning.component.direction, axes, "");
  } else if (turning.derivative == TimeDerivative::third) {
    component_of_jerk(keys, turning.component, "angular-", "");
  } else {
    component(keys, turning.component, axes_or_magnitude, "");
  }
  history(keys, r, scope);
}

namespace {

/// The axis of a joint with the ground that a body slides or turns in.
void guide_axis(Keys& keys, const std::string& name, TransmissionAngleResponse& angle,
                const Scope& scope) {
  const Joint* joint = find_named(scope.scene.joints, name);
  if (joint == nullptr) return;
  const bool is_guide = kind_of(joint->type).has_axis() && joint->bodies[0] == ground_name;
  keys.must("joint", is_guide,
            fmt::format("must name a joint with an axis and \"ground\" as its first body, but "
                        "\"{}\" is none",
                        name));
  const auto& [x, y, z] = joint->axis;
  const double length = std::hypot(x, y, z);
  angle.guide = {x / length, y / length, z / length};
}

}  // namespace

void describe(Keys& keys, TransmissionAngleResponse& angle, R& r, const Scope& scope) {
  keys.about(
      "The acute angle [rad] at which one member pushes another, between the x axes of their "
      "frames, or between a member and the normal of a guide; 0 is a dead centre.");
  keys.exclusive("bodies", "body");
  keys.exclusive("bodies", "joint");
  keys.one_at_least({"bodies", "joint"});
  keys.together("body", "joint");
  const auto has_axis = [&](const std::string& name) {
    const Body* one = find_named(scope.scene.bodies, name);
    return shape_of<PointMass>(one) == nullptr && shape_of<RigidBody>(one) == nullptr;
  };
  const char* rule =
      "must be a beam, which may be \"rigid\", or a body from a file: others have no axis along "
      "which they push";
  std::array<std::string, 2> both;
  keys.two_names(optional_key("bodies"), "body", names_of(scope.scene.bodies), both, "");
  for (std::size_t i = 0; i < 2; ++i) keys.must_item("bodies", i, has_axis(both[i]), rule);
  if (!both[0].empty()) angle.bodies = {both[0], both[1]};
  if (const Body* one = body(keys, optional_key("body"), angle.bodies, scope)) {
    keys.must("body", has_axis(one->name), rule);
  }
  std::string joint;
  keys.name(optional_key("joint"), "joint", names_of(scope.scene.joints), joint,
            "A joint with an axis, and the ground as its first body.");
  guide_axis(keys, joint, angle, scope);
  history(keys, r, scope);
}

void describe(Keys& keys, DriveResponse& drive, R& r, const Scope& scope) {
  keys.about(
      "Torque [N m] (of the drive of an angle) or force [N] (of a displacement) that the drive of "
      "a "
      "joint exerts on its second body, or its power [W]; an integral of the power is an energy "
      "[J].");
  keys.name("joint", "joint", names_of(scope.scene.joints), drive.joint, "A joint with a drive.");
  if (const Joint* joint = find_named(scope.scene.joints, drive.joint)) {
    keys.must("joint", joint->drive.has_value(),
              fmt::format("names the joint \"{}\", which has no drive", joint->name));
    const bool is_angle = joint->drive && joint->drive->coordinate == DrivenCoordinate::angle;
    keys.must("joint", drive.kind != DriveNumber::torque || is_angle,
              fmt::format("names the joint \"{}\", whose drive has a drive-force", joint->name));
    keys.must("joint", drive.kind != DriveNumber::force || !is_angle,
              fmt::format("names the joint \"{}\", whose drive has a drive-torque", joint->name));
  }
  history(keys, r, scope);
}

void describe(Keys& keys, JointMotionResponse& motion, R& r, const Scope& scope) {
  keys.about(
      "Of the second body of a joint against the first: angle [rad] or displacement [m] from that "
      "at the start, its rate [rad/s] or [m/s], or the rate of that [rad/s^2] or [m/s^2].");
  keys.name("joint", "joint", names_of(scope.scene.joints), motion.joint, "");
  keys.other(optional_key("coordinate"), "coordinate", "");
  history(keys, r, scope);
}

void describe(Keys& keys, ReactionResponse& reaction, R& r, const Scope& scope) {
  keys.about("Force [N] or moment [N m] that a joint transmits.");
  keys.name("joint", "joint", names_of(scope.scene.joints), reaction.joint, "");
  keys.choice("direction", reaction.direction, axes_or_magnitude,
              "Global axis, or the length of the vector.");
  history(keys, r, scope);
}

namespace {

bool is_spring(const Load& load) {
  return std::holds_alternative<SpringDamper>(load.element);
}

bool has_motor(const Load& load) {
  const auto* force = std::get_if<JointForce>(&load.element);
  return force != nullptr && (force->motor || force->control);
}

template <class Element>
bool is_damper(const Load& load) {
  const auto* element = std::get_if<Element>(&load.element);
  if (element == nullptr) return false;
  const Number& damping = element->damping;
  return element->resistance || damping.is_bound() || damping.constant != 0.0;
}

bool has_damper(const Load& load) {
  return is_damper<SpringDamper>(load) || is_damper<JointForce>(load);
}

/// A number of loads, and which loads have it.
struct LoadNumberKind {
  LoadNumber type;
  const char* about;
  bool (*is_of)(const Load&);
  const char* loads;
  const char* otherwise;  ///< of another load
};

constexpr LoadNumberKind load_numbers[] = {
    {LoadNumber::spring_length, "Length [m] of a load of the type spring.", is_spring,
     "a load of the type \"spring\"", "is none"},
    {LoadNumber::spring_force, "What a load of the type spring pulls with [N], with its damper.",
     is_spring, "a load of the type \"spring\"", "is none"},
    {LoadNumber::motor_power, "What the motor of a load in a joint supplies [W].", has_motor,
     "a load with a motor in a joint", "has none"},
    {LoadNumber::damper_power,
     "What the damper of a load takes [W]: damping, and resistance to a rate, times rate.",
     has_damper, "a load with \"damping\" or \"resistance\"", "has none"}};
static_assert(are_in_order(load_numbers));

}  // namespace

void describe(Keys& keys, LoadResponse& load, R& r, const Scope& scope) {
  const LoadNumberKind& kind = load_numbers[static_cast<std::size_t>(load.kind)];
  keys.about(kind.about);
  keys.name("load", "load", names_of(scope.scene.loads), load.load, "");
  if (const Load* one = find_named(scope.scene.loads, load.load)) {
    keys.must("load", kind.is_of(*one),
              fmt::format("must name {}, but \"{}\" {}", kind.loads, one->name, kind.otherwise));
  }
  history(keys, r, scope);
}

}  // namespace pleuel::response_tables
