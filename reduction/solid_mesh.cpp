#include "reduction/solid_mesh.hpp"

#include <algorithm>
#include <set>

#include "core/base/disjoint_sets.hpp"
#include "reduction/element_shape.hpp"

namespace pleuel {

namespace {

double volume_of(const SolidMesh& mesh, const SolidElement& element) {
  const Eigen::Matrix3Xd positions = element_positions(mesh, element);
  double volume = 0.0;
  for (const QuadraturePoint& point : quadrature(element.shape)) {
    volume += point.weight * shape_gradient(element.shape, positions, point.at).determinant;
  }
  return volume;
}

}  // namespace

Eigen::Matrix3Xd element_positions(const SolidMesh& mesh, const SolidElement& element) {
  Eigen::Matrix3Xd positions(3, int_size(element.nodes));
  for (int i = 0; i < int_size(element.nodes); ++i) {
    positions.col(i) = mesh.positions.col(element.nodes[i]);
  }
  return positions;
}

void scale_mesh(SolidMesh& mesh, double length, double mass, double time) {
  mesh.positions *= length;
  for (SolidMaterial& material : mesh.materials) {
    material.young *= mass / (length * time * time);
    material.density *= mass / (length * length * length);
  }
}

double mass_of(const SolidMesh& mesh) {
  double mass = 0.0;
  for (const SolidElement& element : mesh.elements) {
    if (element.material < 0 || mesh.materials[element.material].density <= 0.0) return 0.0;
    mass += mesh.materials[element.material].density * volume_of(mesh, element);
  }
  return mass;
}

double volume_of(const SolidMesh& mesh) {
  double volume = 0.0;
  for (const SolidElement& element : mesh.elements) volume += volume_of(mesh, element);
  return volume;
}

std::vector<int> surface_corners(const SolidMesh& mesh) {
  std::map<std::vector<int>, int> faces;
  for (const SolidElement& element : mesh.elements) {
    for (std::vector<int> face : faces_of(element.shape)) {
      for (int& node : face) node = element.nodes[node];
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  }
  std::set<int> corners;
  for (const auto& [face, count] : faces) {
    if (count == 1) corners.insert(face.begin(), face.end());
  }
  return {corners.begin(), corners.end()};
}

std::vector<int> connected_parts(const SolidMesh& mesh) {
  DisjointSets sets(mesh.size());
  for (const SolidElement& element : mesh.elements) {
    for (const int node : element.nodes) sets.join(node, element.nodes.front());
  }
  std::vector<int> parts(mesh.size());
  for (int i = 0; i < mesh.size(); ++i) parts[i] = sets.find(i);
  return parts;
}

}  // namespace pleuel
