#pragma once

#include <cmath>

#include "core/frame/body_frame.hpp"

namespace pleuel {

/// Instead of a direction: the magnitude is asked for.
inline constexpr int magnitude = -1;

/// A component (0 … 2) of a vector, or its magnitude √(x² + y² + z² + ε²). ε = 1e-12 in the unit of
/// the vector keeps the root differentiable at zero; its share is below round-off elsewhere.
template <class Scalar>
Scalar component_of(const Vector3<Scalar>& vector, int direction) {
  using std::sqrt;
  if (direction != magnitude) return vector(direction);
  constexpr double epsilon = 1e-12;
  return sqrt(Scalar(vector.dot(vector)) + epsilon * epsilon);
}

/// Its derivatives with respect to the vector.
inline Eigen::RowVector3d component_slope(const Eigen::Vector3d& vector, int direction) {
  if (direction != magnitude) return Eigen::RowVector3d::Unit(direction);
  return vector.transpose() / component_of<double>(vector, magnitude);
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
