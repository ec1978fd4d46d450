#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/beam/beam.hpp"
#include "core/beam/elastic_coordinates.hpp"

/// Constants of geometric stiffening of an element (core/effects/geometric_stiffening.hpp).
namespace pleuel {

/// Which of the twelve coordinates of an element are elastic coordinates, in their order.
std::vector<int> active_displacements(const ElasticCoordinates& coordinates, int element);

/// b of Δu = bᵀ d, one entry an active coordinate.
Eigen::VectorXd elongation_of(const std::vector<int>& active);

/// κ = EA/ℓ [N/m]
template <class Scalar>
Scalar axial_stiffness(const BeamElement<Scalar>& element) {
  return element.young * element.section.area / element.length;
}

}  // namespace pleuel
