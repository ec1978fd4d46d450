#pragma once

#include <array>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/model/scene_geometry.hpp"

namespace pleuel {

/// What a joint holds of a beam in space, as if the body on its other side were rigid.
struct JointHold {
  double at = 0.0;                         ///< share of the length of the beam
  std::array<bool, 3> displacements = {};  ///< along local x, y, z
  std::array<bool, 3> rotations = {};      ///< about local x, y, z
};

/// What the joints of a scene hold of its beams. A neighbour holds where other joints hold it; a
/// drive holds what it drives. A joint that turns or slides in a direction holds there all the same
/// where its axis is normal to it (to 6°).
class JointHolds {
 public:
  /// @param start  values of the variables that decide the topology: what is held does not change
  ///               with the design
  JointHolds(const Scene& scene, const Design<double>& start);

  std::vector<JointHold> of(const Body& beam) const;

 private:
  bool is_held(const std::string& neighbour, const std::string& body) const;
  JointHold hold_of(const Joint& joint, std::size_t side, const Body& body) const;

  const Scene& scene_;
  const Design<double>& start_;
  std::unordered_map<std::string, std::vector<const Joint*>> joints_;  ///< by body
};

}  // namespace pleuel
