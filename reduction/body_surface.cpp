#include "reduction/body_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

using Triangle = std::array<int, 3>;

/// In which nodes of the mesh are.
std::vector<Triangle> surface_triangles(const SolidMesh& mesh) {
  std::vector<Triangle> triangles;
  for (const std::vector<int>& face : surface_faces(mesh)) {
    for (std::size_t i = 2; i < face.size(); ++i) {
      triangles.push_back({face[0], face[i - 1], face[i]});
    }
  }
  return triangles;
}

/// Of nodes that are taken together: a cell of the grid, and the axis that their surface faces.
using Cell = std::array<int, 4>;

class Grid {
 public:
  Grid(const SolidMesh& mesh, const std::vector<Triangle>& triangles) : positions_(mesh.positions) {
    for (const Triangle& triangle : triangles) {
      const auto corner = [&](int i) { return Eigen::Vector3d(positions_.col(triangle[i])); };
      const Eigen::Vector3d area = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      for (const int node : triangle) {
        normals_.try_emplace(node, Eigen::Vector3d::Zero()).first->second += area;
      }
    }
  }

  int nodes() const { return int_size(normals_); }

  /// @param size  of the cells [m]; 0: each node has its own
  std::map<Cell, std::vector<int>> cells(double size) const {
    std::map<Cell, std::vector<int>> cells;
    for (const auto& [node, normal] : normals_) cells[cell_of(node, normal, size)].push_back(node);
    return cells;
  }

 private:
  Cell cell_of(int node, const Eigen::Vector3d& normal, double size) const {
    if (size == 0.0) return {node, 0, 0, 0};
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const int side = 2 * static_cast<int>(axis) + (normal(axis) < 0.0 ? 1 : 0);
    const auto at = [&](int k) {
      return static_cast<int>(std::floor(positions_(k, node) / size + 0.5));
    };
    return {at(0), at(1), at(2), side};
  }

  const Eigen::Matrix3Xd& positions_;
  std::map<int, Eigen::Vector3d> normals_;
};

std::map<Cell, std::vector<int>> few_cells(const Grid& grid, double extent, int most) {
  constexpr double growth = 1.1, finest = 1e-3;
  auto cells = grid.cells(0.0);
  for (double size = finest * extent; int_size(cells) > most; size *= growth) {
    cells = grid.cells(size);
  }
  return cells;
}

int middle_of(const std::vector<int>& nodes, const Eigen::Matrix3Xd& positions) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int node : nodes) mean += positions.col(node) / static_cast<double>(nodes.size());
  const auto distance = [&](int node) { return (positions.col(node) - mean).squaredNorm(); };
  return *std::min_element(nodes.begin(), nodes.end(),
                           [&](int a, int b) { return distance(a) < distance(b); });
}

/// With the points of the cells as corners, those that have an area left.
std::vector<Triangle> joined(const std::vector<Triangle>& triangles,
                             const std::map<int, int>& point_of) {
  std::vector<Triangle> found;
  std::set<Triangle> known;
  for (const Triangle& triangle : triangles) {
    Triangle points;
    for (std::size_t i = 0; i < 3; ++i) points[i] = point_of.at(triangle[i]);
    Triangle sorted = points;
    std::sort(sorted.begin(), sorted.end());
    const bool has_area = sorted[0] != sorted[1] && sorted[1] != sorted[2];
    if (has_area && known.insert(sorted).second) found.push_back(points);
  }
  return found;
}

}  // namespace

BodySurface body_surface(const SolidMesh& mesh, const Eigen::MatrixXd& shape, int most) {
  const std::vector<Triangle> triangles = surface_triangles(mesh);
  const Eigen::Vector3d extent =
      mesh.positions.rowwise().maxCoeff() - mesh.positions.rowwise().minCoeff();
  const auto cells = few_cells(Grid(mesh, triangles), extent.maxCoeff(), most);
  BodySurface surface;
  surface.positions.resize(3, int_size(cells));
  surface.displacement.resize(3 * int_size(cells), shape.cols());
  std::map<int, int> point_of;
  int point = 0;
  for (const auto& [cell, nodes] : cells) {
    const int middle = middle_of(nodes, mesh.positions);
    surface.positions.col(point) = mesh.positions.col(middle);
    surface.displacement.middleRows<3>(3 * point) = shape.middleRows<3>(3 * middle);
    for (const int node : nodes) point_of[node] = point;
    ++point;
  }
  surface.triangles = joined(triangles, point_of);
  const SolidMaterial& material = material_of(mesh, mesh.elements.front(), "/surface");
  surface.young = material.young;
  surface.poisson = material.poisson;
  return surface;
}

}  // namespace pleuel
