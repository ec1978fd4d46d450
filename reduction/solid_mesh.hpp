#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "reduction/element_shape.hpp"

namespace pleuel {

/// An isotropic material, in the units of the mesh.
struct SolidMaterial {
  std::string name;
  double young = 0.0, poisson = 0.0, density = 0.0;  ///< 0: not given
};

struct SolidElement {
  SolidShape shape;
  std::vector<int> nodes;  ///< indices of columns of SolidMesh::positions
  int material = -1;       ///< index in SolidMesh::materials; −1: not given
};

/// Nodes and elements of a solid body.
struct SolidMesh {
  std::vector<int> numbers;    ///< of the nodes in their file
  Eigen::Matrix3Xd positions;  ///< 3 × nodes
  std::vector<SolidElement> elements;
  std::vector<SolidMaterial> materials;
  std::map<std::string, std::vector<int>> node_sets;  ///< indices; names in capital letters

  int size() const { return static_cast<int>(positions.cols()); }
};

/// @param what  needs it, for the message
/// @throws InputError if it is not given, or has no modulus
const SolidMaterial& material_of(const SolidMesh& mesh, const SolidElement& element,
                                 const char* what);

/// Of the nodes of an element, 3 × nodes.
Eigen::Matrix3Xd element_positions(const SolidMesh& mesh, const SolidElement& element);

/// Multiplies what the mesh measures, by the SI values of its units.
/// @param length, mass, time  one unit of each [m, kg, s]
void scale_mesh(SolidMesh& mesh, double length, double mass, double time);

/// ∫ρ over all elements by quadrature, with the densities of their materials [kg]; 0 where one has
/// none.
double mass_of(const SolidMesh& mesh);

/// ∫1 over all elements by quadrature.
double volume_of(const SolidMesh& mesh);

/// Corners of the faces that one element alone has, the surface of the body: anticlockwise seen from
/// outside.
std::vector<std::vector<int>> surface_faces(const SolidMesh& mesh);

/// Nodes at the corners of these.
std::vector<int> surface_corners(const SolidMesh& mesh);

/// For each node the number of its connected part, counted by the smallest node; nodes of one
/// element are connected.
std::vector<int> connected_parts(const SolidMesh& mesh);

}  // namespace pleuel
