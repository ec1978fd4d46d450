#include "core/scene/reading/mechanism_check.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/scene/held_points.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

constexpr double parallel_tolerance = 1e-9;  // sine of the angle between axes: rounding

void check_that_something_acts_on_every_body(const JsonNode& node, const Scene& scene) {
  std::set<std::string> touched;
  const auto touch = [&](const std::string& body, const Point&, const PointKey&) {
    touched.insert(body);
  };
  for (const Joint& joint : scene.joints) visit_held_points(joint, touch);
  for (const Load& load : scene.loads) visit_held_points(load, touch);
  for (const Body& body : scene.bodies) {
    if (touched.count(body.name) > 0) continue;
    node.at("bodies").at(body.name).fail("is not connected to anything by a joint or a load");
  }
}

void check_that_bodies_can_turn(const JsonNode& node, const Scene& scene, const Joint& joint) {
  for (const std::string& name : joint.bodies) {
    const Body* body = find_named(scene.bodies, name);
    if (body == nullptr || !std::holds_alternative<PointMass>(body->shape)) continue;
    node.fail(fmt::format("needs two bodies that can turn, but \"{}\" is a point mass", name));
  }
}

/// The coordinate of a joint that a load acts along, or is a function of.
std::optional<JointCoordinate> coordinate_of(const Load& load) {
  if (const auto* force = std::get_if<PointForce>(&load.element)) return force->over;
  if (const auto* torque = std::get_if<PointTorque>(&load.element)) return torque->over;
  const auto* force = std::get_if<JointForce>(&load.element);
  if (force == nullptr) return std::nullopt;
  return JointCoordinate{force->joint, force->coordinate};
}

void check_turning(const JsonNode& node, const Scene& scene) {
  for (const Joint& joint : scene.joints) {
    if (!is_driven(joint, DrivenCoordinate::angle)) continue;
    check_that_bodies_can_turn(node.at("joints").at(joint.name).at("drive"), scene, joint);
  }
  for (const Load& load : scene.loads) {
    const std::optional<JointCoordinate> along = coordinate_of(load);
    if (!along || along->coordinate != DrivenCoordinate::angle) continue;
    check_that_bodies_can_turn(node.at("loads").at(load.name), scene,
                               *find_named(scene.joints, along->joint));
  }
}

bool have_same_bodies(const Joint& a, const Joint& b) {
  return a.bodies == b.bodies || (a.bodies[0] == b.bodies[1] && a.bodies[1] == b.bodies[0]);
}

bool have_parallel_axes(const Joint& a, const Joint& b) {
  const Eigen::Vector3d first(a.axis[0], a.axis[1], a.axis[2]);
  const Eigen::Vector3d second(b.axis[0], b.axis[1], b.axis[2]);
  return first.stableNormalized().cross(second.stableNormalized()).norm() <= parallel_tolerance;
}

/// Drives of distances, and of points on lines, may act side by side, as in a hexapod.
bool drive_the_same(const Joint& a, const Joint& b) {
  if (a.drive->coordinate != b.drive->coordinate) return false;
  if (!have_same_bodies(a, b) || !have_parallel_axes(a, b)) return false;
  return a.drive->coordinate == DrivenCoordinate::angle ||
         (kind_of(a.type).is_guide() && kind_of(b.type).is_guide());
}

void check_that_no_motion_is_driven_twice(const JsonNode& node, const Scene& scene) {
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const Joint& joint = scene.joints[i];
    if (!joint.drive) continue;
    for (std::size_t k = 0; k < i; ++k) {
      const Joint& other = scene.joints[k];
      if (!other.drive || !drive_the_same(joint, other)) continue;
      node.at("joints")
          .at(joint.name)
          .at("drive")
          .fail(fmt::format("prescribes the same motion as the drive of the joint \"{}\"",
                            other.name));
    }
  }
}

}  // namespace

void check_mechanism(const JsonNode& node, const Scene& scene) {
  check_that_something_acts_on_every_body(node, scene);
  check_turning(node, scene);
  check_that_no_motion_is_driven_twice(node, scene);
}

}  // namespace pleuel
