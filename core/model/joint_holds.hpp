#pragma once

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/model/rigid_motions.hpp"

namespace pleuel {

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
