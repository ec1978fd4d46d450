#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/int_size.hpp"
#include "core/model/effect_decisions.hpp"
#include "core/model/motion_plane.hpp"

namespace pleuel {

/// Which of some things has a name; of several the last.
template <class Named>
std::unordered_map<std::string, std::size_t> numbers_by_name(const std::vector<Named>& things) {
  std::unordered_map<std::string, std::size_t> numbers;
  for (std::size_t i = 0; i < things.size(); ++i) numbers[things[i].name] = i;
  return numbers;
}

/// What all bodies of a model are built with.
struct BuildContext {
  const Scene& scene;
  const EffectSettings& effects;
  const Design<double>& start;
  const Design<double>& design;
  std::optional<MotionPlane> plane;
  Eigen::Vector3d gravity;
  Differentiation differentiation = {};
  std::map<std::string, BodyEffects> beam_effects = {};  ///< by body
  std::unordered_map<std::string, std::size_t> body_numbers = numbers_by_name(scene.bodies);

  const BodyEffects& effects_of(const std::string& beam) const { return beam_effects.at(beam); }
  int variables() const { return differentiation ? int_size(design) : 0; }
  /// Of the variables that something depends on, those by which it is differentiated: all or none.
  std::set<int> differentiated(std::set<int> variables) const {
    return differentiation ? std::move(variables) : std::set<int>();
  }
  /// The design with one variable seeded.
  Design<Dual> seeded(int variable) const {
    Design<Dual> dual(design.begin(), design.end());
    dual[variable].derivatives()[0] = 1.0;
    return dual;
  }
};

}  // namespace pleuel
