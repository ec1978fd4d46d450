#pragma once

#include <array>
#include <optional>

#include <Eigen/Geometry>

#include "core/base/dual.hpp"
#include "core/scene/number.hpp"

namespace pleuel {

/// Axes of a body that lies as a beam does, body to global: local x from `from` to `to`; local y
/// the part normal to it of the reference vector (by default z × x, or global y for beams along z).
template <class Scalar>
Eigen::Matrix<Scalar, 3, 3> beam_axes(const Point& from, const Point& to,
                                      const std::optional<std::array<double, 3>>& reference,
                                      const Design<Scalar>& design) {
  using Vector = Eigen::Matrix<Scalar, 3, 1>;
  Vector x, y;
  for (int i = 0; i < 3; ++i) {
    x(i) = resolve(to[i], design) - resolve(from[i], design);
  }
  x.normalize();
  if (reference) {
    const Vector given =
        Eigen::Vector3d((*reference)[0], (*reference)[1], (*reference)[2]).template cast<Scalar>();
    const Scalar along = given.dot(x);
    y = given - along * x;
  } else {
    y = Vector(-x(1), x(0), Scalar(0));
    const bool is_vertical = std::abs(value_of(x(0))) + std::abs(value_of(x(1))) < 1e-9;
    if (is_vertical) y = Eigen::Vector3d::UnitY().template cast<Scalar>() - x(1) * x;
  }
  y /= Scalar(y.norm());
  Eigen::Matrix<Scalar, 3, 3> axes;
  axes << x, y, Vector(x.cross(y));
  return axes;
}

}  // namespace pleuel
