#pragma once

#include <array>
#include <string>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "core/model/scene_geometry.hpp"

namespace pleuel {

/// A space of small motions of a rigid body: orthonormal columns (v/L, ω) with the velocity v of a
/// point, a length L and the angular velocity ω, global axes.
using MotionSpace = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 12>;

/// A joint as it is drawn.
struct PlacedJoint {
  JointType type;
  std::array<std::string, 2> bodies;
  Eigen::Vector3d at, to;  ///< [m]
  Eigen::Vector3d axis, second_axis;
  bool drives_angle, drives_displacement;
  bool has_point_mass;  ///< on one of its sides: it has no rotation
};

/// Small motions about the drawn pose that joints leave bodies, as if all were rigid: motions in
/// series add up, joints in parallel leave what each of them leaves. Drives hold what they drive;
/// springs, loads and inertia hold nothing. Bodies that meet again behind different joints count as
/// different ones, and motions that differ by less than 1e-4 as the same: both can only leave more.
class RigidMotions {
 public:
  RigidMotions() = default;
  /// @param start  values of the variables that decide the topology
  RigidMotions(const Scene& scene, const Design<double>& start);

  /// Indices into joint().
  const std::vector<int>& joints_of(const std::string& body) const;
  const PlacedJoint& joint(int index) const { return joints_[index]; }

  /// What a body can do at a joint, without its other joints: the motions that the joint leaves, and
  /// those of the body on the other side.
  /// @param point   whose velocity v is [m]
  /// @param length  L [m]
  MotionSpace left_by(const PlacedJoint& joint, const std::string& body,
                      const Eigen::Vector3d& point, double length) const;

 private:
  class Search;

  std::vector<PlacedJoint> joints_;
  std::unordered_map<std::string, std::vector<int>> of_body_;
};

}  // namespace pleuel
