#pragma once

#include "core/scene/scene.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// What numbers of a force element measure that acts along an angle or a displacement.
struct AlongCoordinate {
  Quantity coordinate, rate, force, stiffness, damping;
};

inline AlongCoordinate along(DrivenCoordinate coordinate) {
  if (coordinate == DrivenCoordinate::angle) {
    return {quantities::angle, quantities::angular_speed, quantities::torque,
            quantities::torsional_stiffness, quantities::torsional_damping};
  }
  return {quantities::length, quantities::speed, quantities::force, quantities::spring_stiffness,
          quantities::damping_constant};
}

/// @param force  a torque or a force
inline AlongCoordinate along(const Quantity& force) {
  return along(force == quantities::torque ? DrivenCoordinate::angle
                                           : DrivenCoordinate::displacement);
}

}  // namespace pleuel
