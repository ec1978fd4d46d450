#include "reduction/stress_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <unordered_map>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "reduction/element_shape.hpp"
#include "reduction/fixed_modes.hpp"

namespace pleuel {

namespace {

/// Displacements of the nodes of an element in one direction, nodes × n.
Eigen::MatrixXd displacements_of(const SolidElement& element, const Eigen::MatrixXd& shape,
                                 int direction) {
  Eigen::MatrixXd u(int_size(element.nodes), shape.cols());
  for (int i = 0; i < int_size(element.nodes); ++i) {
    u.row(i) = shape.row(3 * element.nodes[i] + direction);
  }
  return u;
}

/// σ = λ tr ε 1 + 2 μ ε at a node of an element, 6 × n.
Eigen::MatrixXd element_stress(const SolidMesh& mesh, const SolidElement& element,
                               const Eigen::MatrixXd& shape, int node) {
  const SolidMaterial& material = material_of(mesh, element, "stress");
  const double nu = material.poisson, mu = material.young / (2.0 * (1.0 + nu));
  const double lambda = material.young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  const Eigen::MatrixX3d gradient = shape_gradient(element.shape, element_positions(mesh, element),
                                                   local_node(element.shape, node))
                                        .gradient;
  std::array<Eigen::MatrixXd, 3> slopes;  // ∂u_k/∂x_l in row l
  for (int k = 0; k < 3; ++k) {
    slopes[k] = gradient.transpose() * displacements_of(element, shape, k);
  }
  Eigen::MatrixXd stress(6, shape.cols());
  const Eigen::RowVectorXd dilatation = slopes[0].row(0) + slopes[1].row(1) + slopes[2].row(2);
  for (int k = 0; k < 3; ++k) stress.row(k) = lambda * dilatation + 2.0 * mu * slopes[k].row(k);
  for (int k = 0; k < 3; ++k) {
    const auto [a, b] = std::array<std::pair<int, int>, 3>{{{0, 1}, {1, 2}, {0, 2}}}[k];
    stress.row(3 + k) = mu * (slopes[a].row(b) + slopes[b].row(a));
  }
  return stress;
}

double von_mises(const Eigen::VectorXd& s) {
  const double shear = s(3) * s(3) + s(4) * s(4) + s(5) * s(5);
  const double xy = s(0) - s(1), yz = s(1) - s(2), xz = s(0) - s(2);
  return std::sqrt(0.5 * (xy * xy + yz * yz + xz * xz) + 3.0 * shear);
}

int largest_of(const Eigen::VectorXd& stress) {
  double most = -1.0;
  int largest = 0;
  for (int i = 0; i < int_size(stress) / 6; ++i) {
    const double value = von_mises(stress.segment<6>(6 * i));
    if (value > most) {
      most = value;
      largest = i;
    }
  }
  return largest;
}

/// Unit vectors that fill the sphere evenly enough, the same in every run: a sequence of additive
/// recurrences made normal numbers by sums.
Eigen::MatrixXd directions(int size, int count) {
  Eigen::MatrixXd d(size, count);
  RepeatedChance chance(54321);
  for (double& number : d.reshaped()) {
    number = -6.0;
    for (int i = 0; i < 12; ++i) number += chance() / 4294967296.0;
  }
  return d;
}

}  // namespace

Eigen::MatrixXd nodal_stress(const SolidMesh& mesh, const Eigen::MatrixXd& shape,
                             const std::vector<int>& nodes) {
  std::unordered_map<int, int> rows;
  for (int i = 0; i < int_size(nodes); ++i) rows[nodes[i]] = i;
  Eigen::MatrixXd stress = Eigen::MatrixXd::Zero(6 * int_size(nodes), shape.cols());
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(int_size(nodes));
  for (const SolidElement& element : mesh.elements) {
    for (int i = 0; i < corner_count(element.shape); ++i) {
      const auto row = rows.find(element.nodes[i]);
      if (row == rows.end()) continue;
      stress.middleRows<6>(6 * row->second) += element_stress(mesh, element, shape, i);
      counts(row->second) += 1.0;
    }
  }
  for (int i = 0; i < int_size(nodes); ++i) stress.middleRows<6>(6 * i) /= counts(i);
  return stress;
}

std::vector<int> most_stressed(const Eigen::MatrixXd& stress, const Eigen::MatrixXd& stiffness,
                               int most) {
  constexpr int samples = 2000;
  const int points = int_size(stress.col(0)) / 6;
  std::vector<int> order(points);
  for (int i = 0; i < points; ++i) order[i] = i;
  if (points <= most) return order;
  // q = L⁻ᵀ d has the energy ½ dᵀd: with K = L Lᵀ.
  const Eigen::MatrixXd lower = Cholesky(stiffness).lower();
  const Eigen::MatrixXd per_direction =
      DenseLu(lower).solve(Eigen::MatrixXd(stress.transpose())).transpose();
  const Eigen::MatrixXd all = directions(int_size(stiffness.col(0)), samples);
  std::vector<int> hits(points, 0);
  for (int i = 0; i < samples; ++i) ++hits[largest_of(per_direction * all.col(i))];
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return hits[a] > hits[b]; });
  order.resize(most);
  std::erase_if(order, [&](int i) { return hits[i] == 0; });
  std::sort(order.begin(), order.end());
  return order;
}

std::vector<int> corners_among(const SolidMesh& mesh, const std::vector<int>& nodes) {
  std::set<int> corners;
  for (const SolidElement& element : mesh.elements) {
    corners.insert(element.nodes.begin(), element.nodes.begin() + corner_count(element.shape));
  }
  std::vector<int> among;
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(among),
               [&](int node) { return corners.contains(node); });
  return among;
}

}  // namespace pleuel
