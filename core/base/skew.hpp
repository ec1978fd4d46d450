#pragma once

#include <Eigen/Core>

#include "core/base/small_matrices.hpp"

namespace pleuel {

/// w̃ of the cross product: w̃ u = w × u.
template <class Scalar>
Eigen::Matrix<Scalar, 3, 3> skew(const Eigen::Matrix<Scalar, 3, 1>& w) {
  Eigen::Matrix<Scalar, 3, 3> matrix;
  const Scalar zero(0);
  matrix << zero, -w(2), w(1), w(2), zero, -w(0), -w(1), w(0), zero;
  return matrix;
}

}  // namespace pleuel
