#include "core/model/joint_holds.hpp"

#include <algorithm>

namespace pleuel {

namespace {

/// Of small motions of unit size: what has less than this share of them in a direction (as sin 6°)
/// counts as held in it.
constexpr double held_share = 0.1;

}  // namespace

JointHolds::JointHolds(const Scene& scene, const Design<double>& start) : motions_(scene, start) {
  for (const Body& body : scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr) continue;
    const Pose<double> pose = beam_pose(*beam, start);
    beams_[body.name] = {pose, (resolve_point(beam->to, start) - pose.origin).norm()};
  }
}

std::vector<JointHold> JointHolds::of(const std::string& beam) const {
  std::vector<JointHold> holds;
  for (const int joint : motions_.joints_of(beam)) {
    holds.push_back(hold_of(motions_.joint(joint), beam));
  }
  return holds;
}

JointHold JointHolds::hold_of(const PlacedJoint& joint, const std::string& beam) const {
  const auto& [pose, length] = beams_.at(beam);
  const Eigen::Vector3d& point = joint.bodies[1] == beam ? joint.to : joint.at;
  const MotionSpace left = motions_.left_by(joint, beam, point, length);
  const auto is_held = [&](const Eigen::Vector3d& direction, Eigen::Index first) {
    return (direction.transpose() * left.middleRows(first, 3)).norm() <= held_share;
  };
  JointHold hold;
  hold.at = std::clamp((point - pose.origin).dot(pose.rotation.col(0)) / length, 0.0, 1.0);
  for (int i = 0; i < 3; ++i) {
    hold.displacements[i] = is_held(pose.rotation.col(i), 0);
    hold.rotations[i] = is_held(pose.rotation.col(i), 3);
  }
  return hold;
}

}  // namespace pleuel
