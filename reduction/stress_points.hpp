#pragma once

#include <vector>

#include "reduction/component_modes.hpp"

namespace pleuel {

/// Stress at nodes from the deformation, six rows a node per coordinate, σ_xx σ_yy σ_zz τ_xy τ_yz τ_xz
/// [Pa]: Hooke's law with the strain of each element at the node, the mean of the elements around it.
/// @param nodes  corners of elements
/// @throws InputError if an element has no modulus or Poisson ratio
Eigen::MatrixXd nodal_stress(const SolidMesh& mesh, const Eigen::MatrixXd& shape,
                             const std::vector<int>& nodes);

/// Nodes that can have the largest von Mises stress of all: those that have it for one of many
/// deformations, each with the same strain energy: the coordinates that the body has when loads act on its
/// interfaces, in directions spread over all. The most frequent ones first.
/// @param stress     rows of nodal_stress()
/// @param stiffness  n × n
/// @param most       so many at most
/// @returns          indices of the nodes of the rows, in rising order
std::vector<int> most_stressed(const Eigen::MatrixXd& stress, const Eigen::MatrixXd& stiffness,
                               int most);

/// Nodes of a selection that are corners of elements: there the strain is known.
std::vector<int> corners_among(const SolidMesh& mesh, const std::vector<int>& nodes);

}  // namespace pleuel
