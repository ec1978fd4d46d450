#pragma once

#include <array>
#include <optional>
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

/// What a joint holds of a beam in space, as if all other bodies were rigid.
struct JointHold {
  double at = 0.0;                         ///< share of the length of the beam
  std::array<bool, 3> displacements = {};  ///< along local x, y, z
  std::array<bool, 3> rotations = {};      ///< about local x, y, z
};

/// Places that something outside of the mechanism holds (OutsideHold).
struct HeldPlaces {
  std::array<bool, 3> displacements = {};  ///< along local x, y, z
  std::vector<double> at;                  ///< shares of the length; empty: all along
};

/// What the joints of a scene hold of its beams where these bend: the directions in which the
/// mechanism does not let the place of a joint move, apart from motions in which the beam stays
/// straight (RigidMotions::end_motions). Motions within 6° of a right angle to a direction do not
/// count.
class JointHolds {
 public:
  JointHolds() = default;
  /// @param start  values of the variables that decide the topology: what is held does not change
  ///               with the design
  JointHolds(const Scene& scene, const Design<double>& start);

  /// @param beam  name of a beam of the scene
  std::vector<JointHold> of(const std::string& beam) const;
  /// Null if the file says of no such place.
  const HeldPlaces* outside(const std::string& beam) const;

 private:
  struct Axis {
    Pose<double> pose;
    double length;
    std::optional<HeldPlaces> held;
  };

  RigidMotions motions_;
  std::unordered_map<std::string, Axis> beams_;
};

}  // namespace pleuel
