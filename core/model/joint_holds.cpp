#include "core/model/joint_holds.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"

namespace pleuel {

namespace {

/// Of small motions of unit size: what has less than this share of them in a direction (as sin 6°)
/// counts as held in it.
constexpr double held_share = 0.1;

std::optional<HeldPlaces> held_places(const std::string& name, const BeamBody& beam,
                                      const Eigen::Matrix3d& axes) {
  if (!beam.held) return std::nullopt;
  const Eigen::Map<const Eigen::Vector3d> direction(beam.held->direction.data());
  const Eigen::Vector3d across = axes.transpose() * direction;
  HeldPlaces held{{}, beam.held->at};
  for (int i = 0; i < 3; ++i)
    held.displacements[i] = std::abs(across(i)) > 1.0 - held_share * held_share;
  if (held.displacements[1] || held.displacements[2]) return held;
  throw InputError(fmt::format(
      "/scene/bodies/{}/held/direction must be across the beam, along its local y or z", name));
}

}  // namespace

JointHolds::JointHolds(const Scene& scene, const Design<double>& start) : motions_(scene, start) {
  for (const Body& body : scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr) continue;
    const Pose<double> pose = beam_pose(*beam, start);
    beams_[body.name] = {pose, (resolve_point(beam->to, start) - pose.origin).norm(),
                         held_places(body.name, *beam, pose.rotation)};
  }
}

const HeldPlaces* JointHolds::outside(const std::string& beam) const {
  const std::optional<HeldPlaces>& held = beams_.at(beam).held;
  return held ? &*held : nullptr;
}

std::vector<JointHold> JointHolds::of(const std::string& beam) const {
  const auto& [pose, length, held] = beams_.at(beam);
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
