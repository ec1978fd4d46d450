#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/scene/body_constants.hpp"
#include "reduction/solid_matrices.hpp"

/// Where a body meets others: a set of nodes with six coordinates, displacement and small rotation of
/// its reference point.
namespace pleuel {

struct InterfaceSet {
  std::string name;
  std::vector<int> nodes;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< reference point [m]
  bool is_rigid = true;  ///< the nodes move as one; else their mean motion is the interface's
};

/// Displacement of a node of a rigid set: uᵢ = [1 −d̃ᵢ] [u; θ], d from the reference point. 3n × 6.
Eigen::MatrixXd rigid_rows(const InterfaceSet& set, const Eigen::Matrix3Xd& positions);

/// Mean motion of a set of nodes, all with the same weight: the rigid motion next to theirs in least
/// squares, [u; θ] = (RᵀR)⁻¹ Rᵀ uᵢ with R from rigid_rows(). 6 × 3n.
/// @throws InputError if the nodes are on one line: they have no rotation
Eigen::MatrixXd mean_rows(const InterfaceSet& set, const Eigen::Matrix3Xd& positions);

/// Mean motion of a set per coordinate, 6 × n.
/// @param shape  displacements of all nodes per coordinate, 3 nodes × n
Eigen::MatrixXd mean_motion(const InterfaceSet& set, const Eigen::Matrix3Xd& positions,
                            const Eigen::MatrixXd& shape);

/// The centroid of nodes, all with the same weight.
Eigen::Vector3d centroid_of(const std::vector<int>& nodes, const Eigen::Matrix3Xd& positions);

/// Coordinates of a body that is its own mirror image about a plane through the origin and moves in
/// it: those that move it as its mirror image does, (u, v) in the plane and the rotation about the
/// normal. Of a mode inertia tells: it couples with one kind only.
/// @param constants   of all coordinates
/// @param normal      0, 1 or 2: the x, y or z axis
/// @param prescribed  the first so many coordinates are of interfaces, six each; the rest are modes
std::vector<int> coordinates_in_plane(const BodyConstants& constants, int normal, int prescribed);

/// Takes out what couples such coordinates with motions across the plane: nothing but how little the
/// mesh is symmetric.
/// @returns the largest of it, relative to the numbers of its kind
double clear_across_plane(BodyConstants& constants, int normal);

}  // namespace pleuel
