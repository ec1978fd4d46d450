#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "core/scene/number.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// Whether it depends on design variables.
inline bool is_bound(const Point& point) {
  return std::ranges::any_of(point, [](const Number& number) { return number.is_bound(); });
}

/// [m], global axes
template <class Scalar>
Eigen::Matrix<Scalar, 3, 1> resolve_point(const Point& point, const Design<Scalar>& design) {
  return {resolve(point[0], design), resolve(point[1], design), resolve(point[2], design)};
}

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
