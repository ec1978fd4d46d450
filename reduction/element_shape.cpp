#include "reduction/element_shape.hpp"

#include <array>
#include <cmath>

#include <Eigen/LU>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

/// Ends of the edges that have a node in their middle, in the order of these nodes.
using Edges = std::vector<std::array<int, 2>>;

bool is_tetrahedron(SolidShape shape) {
  return shape == SolidShape::tetrahedron4 || shape == SolidShape::tetrahedron10;
}

const Edges& edges_of(SolidShape shape) {
  static const Edges tetrahedron = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  static const Edges hexahedron = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                   {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  return is_tetrahedron(shape) ? tetrahedron : hexahedron;
}

Eigen::Vector3d corner(SolidShape shape, int i) {
  if (is_tetrahedron(shape)) return {double(i == 1), double(i == 2), double(i == 3)};
  const bool right = i % 4 == 1 || i % 4 == 2, far = i % 4 >= 2;
  return {right ? 1.0 : -1.0, far ? 1.0 : -1.0, i >= 4 ? 1.0 : -1.0};
}

Eigen::MatrixX3d tetrahedron_derivatives(SolidShape shape, const Eigen::Vector3d& at) {
  Eigen::Vector4d l;  // barycentric coordinates, and their derivatives
  l << 1.0 - at.sum(), at;
  Eigen::Matrix<double, 4, 3> d;
  d << Eigen::RowVector3d::Constant(-1.0), Eigen::Matrix3d::Identity();
  if (shape == SolidShape::tetrahedron4) return d;
  Eigen::MatrixX3d n(10, 3);
  for (int i = 0; i < 4; ++i) n.row(i) = (4.0 * l(i) - 1.0) * d.row(i);
  const Edges& edges = edges_of(shape);
  for (int k = 0; k < 6; ++k) {
    const auto [a, b] = edges[k];
    n.row(4 + k) = 4.0 * (l(a) * d.row(b) + l(b) * d.row(a));
  }
  return n;
}

/// One factor of a function of a hexahedron along an axis: 1 + p r at a corner, 1 − r² in the middle.
double factor(double p, double r) {
  return p == 0.0 ? 1.0 - r * r : 1.0 + p * r;
}

double factor_derivative(double p, double r) {
  return p == 0.0 ? -2.0 * r : p;
}

/// Of N = c Π fₖ, for corners of 20 nodes times (p·r − 2), with c = 1/8, or 1/4 in the middle of edges.
Eigen::MatrixX3d hexahedron_derivatives(SolidShape shape, const Eigen::Vector3d& at) {
  const bool is_quadratic = shape == SolidShape::hexahedron20;
  Eigen::MatrixX3d n(node_count(shape), 3);
  for (int i = 0; i < int_size(n.col(0)); ++i) {
    const Eigen::Vector3d p = local_node(shape, i);
    for (int k = 0; k < 3; ++k) {
      double others = i < 8 ? 0.125 : 0.25;
      for (int l = 0; l < 3; ++l) others *= l == k ? 1.0 : factor(p(l), at(l));
      const double own = factor(p(k), at(k)), rise = factor_derivative(p(k), at(k));
      const bool is_corner = is_quadratic && i < 8;
      n(i, k) = others * (is_corner ? rise * (p.dot(at) - 2.0) + own * p(k) : rise);
    }
  }
  return n;
}

/// Keast's rule of 15 points and fifth order would do; a product of Gauss's rules on a cube that is
/// folded to the tetrahedron is exact, too, and needs no table (Karniadakis & Sherwin 2005, §4.1.1).
std::vector<QuadraturePoint> folded(const std::vector<QuadraturePoint>& cube) {
  std::vector<QuadraturePoint> points;
  for (const auto& [at, weight] : cube) {
    const Eigen::Vector3d u = (0.5 * (at.array() + 1.0)).matrix();
    const double s = u(1) * (1.0 - u(2)), r = u(0) * (1.0 - u(1)) * (1.0 - u(2));
    points.push_back({{r, s, u(2)}, 0.125 * weight * (1.0 - u(1)) * std::pow(1.0 - u(2), 2)});
  }
  return points;
}

/// Gauss's rule of four points on each axis, exact to the seventh order.
std::vector<QuadraturePoint> cube_points() {
  const double root = std::sqrt(4.8);  // 2 √(6/5)
  const std::array<double, 2> x = {std::sqrt((3.0 - root) / 7.0), std::sqrt((3.0 + root) / 7.0)};
  const std::array<double, 2> w = {(18.0 + std::sqrt(30.0)) / 36.0,
                                   (18.0 - std::sqrt(30.0)) / 36.0};
  const std::array<std::pair<double, double>, 4> line = {
      {{-x[1], w[1]}, {-x[0], w[0]}, {x[0], w[0]}, {x[1], w[1]}}};
  std::vector<QuadraturePoint> points;
  for (const auto& [r, a] : line) {
    for (const auto& [s, b] : line) {
      for (const auto& [t, c] : line) points.push_back({{r, s, t}, a * b * c});
    }
  }
  return points;
}

}  // namespace

int node_count(SolidShape shape) {
  constexpr std::array<int, 4> counts = {4, 10, 8, 20};
  return counts[static_cast<std::size_t>(shape)];
}

int corner_count(SolidShape shape) {
  return is_tetrahedron(shape) ? 4 : 8;
}

Eigen::Vector3d local_node(SolidShape shape, int node) {
  const int corners = corner_count(shape);
  if (node < corners) return corner(shape, node);
  const auto [a, b] = edges_of(shape)[node - corners];
  return 0.5 * (corner(shape, a) + corner(shape, b));
}

Eigen::MatrixX3d shape_derivatives(SolidShape shape, const Eigen::Vector3d& local) {
  return is_tetrahedron(shape) ? tetrahedron_derivatives(shape, local)
                               : hexahedron_derivatives(shape, local);
}

std::vector<QuadraturePoint> quadrature(SolidShape shape) {
  return is_tetrahedron(shape) ? folded(cube_points()) : cube_points();
}

std::vector<std::vector<int>> faces_of(SolidShape shape) {
  if (is_tetrahedron(shape)) return {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}};
  return {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
}

ShapeGradient shape_gradient(SolidShape shape, const Eigen::Matrix3Xd& positions,
                             const Eigen::Vector3d& local) {
  const Eigen::MatrixX3d d = shape_derivatives(shape, local);
  const Eigen::Matrix3d jacobian = positions * d;
  return {d * jacobian.inverse(), jacobian.determinant()};
}

}  // namespace pleuel
