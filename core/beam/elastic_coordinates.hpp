#pragma once

/// Which nodal displacements of a beam are its elastic coordinates q_f.

/// Constants of geometric stiffening of an element (core/effects/geometric_stiffening.hpp).

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/base/int_size.hpp"
#include "core/beam/beam.hpp"

namespace pleuel {

/// The six displacements of a node in local axes, in this order: u v w θx θy θz.
using NodalFlags = std::array<bool, 6>;

class ElasticCoordinates {
 public:
  /// @param node_count  nodes of the beam
  /// @param active      displacements that the scene can excite; others have no coordinates
  ElasticCoordinates(int node_count, const NodalFlags& active);

  /// Removes a displacement that the reference condition sets to zero.
  void clamp(int node, int displacement);

  int size() const { return size_; }
  int node_count() const { return int_size(index_); }

  /// Index in q_f of a nodal displacement, or −1 where it is zero.
  int index(int node, int displacement) const { return index_[node][displacement]; }

  /// Indices in q_f of the twelve coordinates of an element (nodes `element`, `element` + 1).
  std::array<int, 12> element_indices(int element) const;

 private:
  void number();

  std::vector<std::array<int, 6>> index_;
  int size_ = 0;
};

/// Tangent frame: the first node is clamped in the body frame.
ElasticCoordinates tangent_coordinates(int node_count, const NodalFlags& active);

/// Tangent frame at the other end: the last node is clamped.
ElasticCoordinates tangent_end_coordinates(int node_count, const NodalFlags& active);

/// Chord frame: u, v, w, θx of the first node and v, w of the last vanish.
ElasticCoordinates chord_coordinates(int node_count, const NodalFlags& active);

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
