#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.hpp"

namespace pleuel {

/// A law of time with which a drive or a load acts.
struct ActingLaw {
  enum class Kind {
    drive,  ///< motion of a joint
    load,   ///< value of a force or torque
    motor,  ///< force or torque of a motor in a joint
    target  ///< motion that a controlled motor in a joint follows
  };

  Kind kind;
  const std::string& name;  ///< of the joint or load
  const TimeFunction& function;
  bool is_displacement;  ///< of a motion: [m], else [rad]

  bool is_motion() const { return kind == Kind::drive || kind == Kind::target; }
  /// In the problem file: "/scene/joints/bearing/drive".
  std::string pointer() const;
};

/// Of all drives, then of all loads, in the order of the scene, which must outlive them.
std::vector<ActingLaw> acting_laws(const Scene& scene);

}  // namespace pleuel
