#pragma once

/// Shape functions of solid elements in the order of nodes of CalculiX (Dhondt 2004, The Finite
/// Element Method for Three-dimensional Thermomechanical Applications, §2.1): corners first, then
/// middles of edges. Tetrahedra live in r, s, t ≥ 0, r + s + t ≤ 1; hexahedra in [−1, 1]³.

#include <vector>

#include <Eigen/Core>

namespace pleuel {

/// Solid finite elements whose shapes are known (element_shape.hpp), by their names in CalculiX.
enum class SolidShape { tetrahedron4, tetrahedron10, hexahedron8, hexahedron20 };

struct QuadraturePoint {
  Eigen::Vector3d at;  ///< local
  double weight;
};

int node_count(SolidShape shape);
int corner_count(SolidShape shape);

/// dN/d(r, s, t) of all nodes, nodes × 3.
Eigen::MatrixX3d shape_derivatives(SolidShape shape, const Eigen::Vector3d& local);

/// Where a node is, in local coordinates.
Eigen::Vector3d local_node(SolidShape shape, int node);

/// Exact for products of two shape functions of an element with straight edges.
std::vector<QuadraturePoint> quadrature(SolidShape shape);

/// Corners of each face.
std::vector<std::vector<int>> faces_of(SolidShape shape);

/// Derivatives of the shape functions in space, nodes × 3 [1/m], and the determinant of the
/// Jacobian: volume per local volume.
struct ShapeGradient {
  Eigen::MatrixX3d gradient;
  double determinant;
};

/// @param positions  of the nodes of the element, 3 × nodes
ShapeGradient shape_gradient(SolidShape shape, const Eigen::Matrix3Xd& positions,
                             const Eigen::Vector3d& local);

}  // namespace pleuel
