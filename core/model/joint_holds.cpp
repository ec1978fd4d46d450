#include "core/model/joint_holds.hpp"

#include <algorithm>

#include "core/base/eager_matrices.hpp"

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
  const auto& [pose, length] = beams_.at(beam);
  const Eigen::Vector3d direction = pose.rotation.col(0);
  const std::vector<MotionSpace> motions =
      motions_.end_motions(beam, {pose.origin + 0.5 * length * direction, direction, length});
  std::vector<JointHold> holds;
  for (const int index : motions_.joints_of(beam)) {
    const PlacedJoint& joint = motions_.joint(index);
    const Eigen::Vector3d& point = joint.bodies[1] == beam ? joint.to : joint.at;
    const MotionSpace& left = motions[holds.size()];
    const auto is_held = [&](const Eigen::Vector3d& along, Eigen::Index first) {
      return (along.transpose() * left.middleRows(first, 3)).norm() <= held_share;
    };
    JointHold& hold = holds.emplace_back();
    hold.at = std::clamp((point - pose.origin).dot(direction) / length, 0.0, 1.0);
    for (int i = 0; i < 3; ++i) {
      hold.displacements[i] = is_held(pose.rotation.col(i), 0);
      hold.rotations[i] = is_held(pose.rotation.col(i), 3);
    }
  }
  return holds;
}

}  // namespace pleuel
