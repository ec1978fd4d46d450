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

/// A beam among rigid bodies.
struct BeamAxis {
  Eigen::Vector3d middle, direction;  ///< [m], of length 1
  double length = 1.0;                ///< [m]
};

/// Small motions about the drawn pose, as if all bodies but one beam were rigid. Drives hold what
/// they drive; springs, loads and inertia hold nothing.
class RigidMotions {
 public:
  RigidMotions() = default;
  /// @param start  values of the variables that decide the topology
  RigidMotions(const Scene& scene, const Design<double>& start);

  /// Indices into joint().
  const std::vector<int>& joints_of(const std::string& body) const;
  const PlacedJoint& joint(int index) const { return joints_[index]; }

  /// How a beam can move where its joints are while it bends and twists, one space a joint of
  /// joints_of(beam): what the joints and all other bodies, in loops, too, leave to a beam that keeps
  /// its length. Motions of the mechanism in which the beam stays straight are taken off: of one end, so
  /// that the other moves against it, or, where no end moves, of its turning. Bodies beyond the 60
  /// nearest move as they like.
  std::vector<MotionSpace> end_motions(const std::string& beam, const BeamAxis& axis) const;

 private:
  std::vector<std::string> bodies_around(const std::string& beam) const;

  std::vector<PlacedJoint> joints_;
  std::unordered_map<std::string, std::vector<int>> of_body_;
};

}  // namespace pleuel
