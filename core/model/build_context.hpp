#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/model/effect_decisions.hpp"
#include "core/model/motion_plane.hpp"

namespace pleuel {

/// What all bodies of a model are built with.
struct BuildContext {
  const Scene& scene;
  const EffectSettings& effects;
  const Design<double>& start;
  const Design<double>& design;
  std::optional<MotionPlane> plane;
  Eigen::Vector3d gravity;
  InvariantDifferentiation differentiation = {};
  std::map<std::string, BeamEffects> beam_effects = {};  ///< by body

  const BeamEffects& effects_of(const std::string& beam) const { return beam_effects.at(beam); }
  int variables() const { return static_cast<int>(design.size()); }
  /// The design with one variable seeded.
  Design<Dual> seeded(int variable) const;
};

}  // namespace pleuel
