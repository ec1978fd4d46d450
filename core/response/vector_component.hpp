#pragma once

#include <cmath>

#include "core/frame/body_frame.hpp"
#include "core/scene/magnitude_direction.hpp"

namespace pleuel {

/// A component (0 … 2) of a vector, or its magnitude √(x² + y² + z² + ε²). ε = 1e-30 in the unit of
/// the vector keeps the root differentiable at zero; its share is below round-off elsewhere.
template <class Scalar>
Scalar component_of(const Vector3<Scalar>& vector, int direction) {
  using std::sqrt;
  if (direction != magnitude_direction) return vector(direction);
  constexpr double epsilon = 1e-30;
  return sqrt(Scalar(vector.dot(vector)) + epsilon * epsilon);
}

/// Its derivatives with respect to the vector.
inline Eigen::RowVector3d component_slope(const Eigen::Vector3d& vector, int direction) {
  if (direction != magnitude_direction) return Eigen::RowVector3d::Unit(direction);
  return vector.transpose() / component_of<double>(vector, magnitude_direction);
}

inline const char* component_name(int direction) {
  switch (direction) {
    case 0:
      return "global x";
    case 1:
      return "global y";
    case 2:
      return "global z";
    default:
      return "magnitude";
  }
}

}  // namespace pleuel
