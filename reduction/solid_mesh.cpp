#include "reduction/solid_mesh.hpp"

#include <algorithm>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/base/disjoint_sets.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
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

/// The nodes of a face, anticlockwise seen from outside of the element.
std::vector<int> outward_face(const SolidMesh& mesh, const SolidElement& element,
                              const std::vector<int>& corners) {
  std::vector<int> face;
  for (const int corner : corners) face.push_back(element.nodes[corner]);
  const auto at = [&](int i) { return Eigen::Vector3d(mesh.positions.col(face[i])); };
  const Eigen::Vector3d centre = element_positions(mesh, element).rowwise().mean();
  const Eigen::Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0));
  if (normal.dot(at(0) - centre) < 0.0) std::reverse(face.begin(), face.end());
  return face;
}

}  // namespace

const SolidMaterial& material_of(const SolidMesh& mesh, const SolidElement& element,
                                 const char* what) {
  if (element.material >= 0 && mesh.materials[element.material].young > 0.0) {
    return mesh.materials[element.material];
  }
  throw InputError(fmt::format(
      "{} needs *ELASTIC and *SOLID SECTION for all elements of the mesh: one has no modulus of "
      "elasticity",
      what));
}

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

std::vector<std::vector<int>> surface_faces(const SolidMesh& mesh) {
  std::map<std::vector<int>, std::vector<std::vector<int>>> faces;
  for (const SolidElement& element : mesh.elements) {
    for (const std::vector<int>& corners : faces_of(element.shape)) {
      std::vector<int> face = outward_face(mesh, element, corners), sorted = face;
      std::sort(sorted.begin(), sorted.end());
      faces[sorted].push_back(std::move(face));
    }
  }
  std::vector<std::vector<int>> outer;
  for (const auto& [sorted, same] : faces) {
    if (same.size() == 1) outer.push_back(same.front());
  }
  return outer;
}

std::vector<int> surface_corners(const SolidMesh& mesh) {
  std::set<int> corners;
  for (const std::vector<int>& face : surface_faces(mesh)) {
    corners.insert(face.begin(), face.end());
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
