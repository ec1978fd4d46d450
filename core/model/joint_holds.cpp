#include "core/model/joint_holds.hpp"

#include <algorithm>
#include <cmath>

namespace pleuel {

namespace {

/// Directions within some 6° of a right angle count as normal, as in 0.1 = sin 6°.
constexpr double normal = 0.1;

bool is_drive_of(const Joint& joint, DrivenCoordinate coordinate) {
  return joint.drive && joint.drive->coordinate == coordinate;
}

bool slides(const Joint& joint) {
  return joint.type == JointType::prismatic || joint.type == JointType::cylindrical ||
         joint.type == JointType::point_on_line;
}

/// Whether the joint holds displacements along a direction.
bool holds_along(const Joint& joint, const Eigen::Vector3d& axis,
                 const Eigen::Vector3d& direction) {
  const bool is_along = std::abs(axis.dot(direction)) > 1.0 - normal;
  if (joint.type == JointType::distance) return false;
  if (joint.type == JointType::planar) return is_along;
  if (!slides(joint)) return true;
  return !is_along || is_drive_of(joint, DrivenCoordinate::displacement);
}

/// Whether it holds rotations about a direction.
bool holds_about(const Joint& joint, const Eigen::Vector3d& axis,
                 const Eigen::Vector3d& direction) {
  const bool is_normal = std::abs(axis.dot(direction)) <= normal;
  const bool is_held = is_normal || is_drive_of(joint, DrivenCoordinate::angle);
  switch (joint.type) {
    case JointType::fixed:
    case JointType::prismatic:
      return true;
    case JointType::revolute:
    case JointType::cylindrical:
    case JointType::planar:
      return is_held;
    case JointType::universal:
      return is_held &&
             std::abs(to_vector(joint.second_axis).normalized().dot(direction)) <= normal;
    case JointType::spherical:
    case JointType::point_on_line:
    case JointType::distance:
      break;
  }
  return false;
}

bool is_point(const Scene& scene, const std::string& name) {
  const Body* body = find_named(scene.bodies, name);
  return body != nullptr && std::holds_alternative<PointMass>(body->shape);
}

}  // namespace

JointHolds::JointHolds(const Scene& scene, const Design<double>& start)
    : scene_(scene), start_(start) {
  for (const Joint& joint : scene.joints) {
    for (const std::string& body : joint.bodies) joints_[body].push_back(&joint);
  }
}

std::vector<JointHold> JointHolds::of(const Body& beam) const {
  std::vector<JointHold> holds;
  const auto found = joints_.find(beam.name);
  if (found == joints_.end()) return holds;
  for (const Joint* joint : found->second) {
    const std::size_t side = joint->bodies[0] == beam.name ? 0 : 1;
    if (is_held(joint->bodies[1 - side], beam.name)) holds.push_back(hold_of(*joint, side, beam));
  }
  return holds;
}

/// A neighbour holds where it is held itself.
bool JointHolds::is_held(const std::string& neighbour, const std::string& body) const {
  if (neighbour == ground_name) return true;
  const std::vector<const Joint*>& joints = joints_.at(neighbour);
  return std::any_of(joints.begin(), joints.end(), [&](const Joint* joint) {
    return joint->bodies[0] != body && joint->bodies[1] != body;
  });
}

JointHold JointHolds::hold_of(const Joint& joint, std::size_t side, const Body& body) const {
  const BeamBody& beam = std::get<BeamBody>(body.shape);
  const Pose<double> pose = beam_pose(beam, start_);
  const bool is_other_end = joint.type == JointType::distance && side == 1;
  const Eigen::Vector3d point = resolve_point(is_other_end ? joint.to : joint.at, start_);
  const double length = (resolve_point(beam.to, start_) - pose.origin).norm();
  JointHold hold;
  hold.at = std::clamp((point - pose.origin).dot(pose.rotation.col(0)) / length, 0.0, 1.0);
  const Eigen::Vector3d axis = to_vector(joint.axis).normalized();
  const bool is_at_point = is_point(scene_, joint.bodies[1 - side]);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d direction = pose.rotation.col(i);
    const auto k = static_cast<std::size_t>(i);
    hold.displacements[k] = holds_along(joint, axis, direction);
    hold.rotations[k] = !is_at_point && holds_about(joint, axis, direction);
  }
  return hold;
}

}  // namespace pleuel
