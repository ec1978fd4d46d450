#include "reduction/interface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/base/rotation_vector.hpp"
#include "reduction/nodal_invariants.hpp"

namespace pleuel {

Eigen::MatrixXd rigid_rows(const InterfaceSet& set, const Eigen::Matrix3Xd& positions) {
  Eigen::MatrixXd rows(3 * int_size(set.nodes), 6);
  for (int i = 0; i < int_size(set.nodes); ++i) {
    const Eigen::Vector3d arm = set.at - positions.col(set.nodes[i]);
    rows.block<3, 3>(3 * i, 0).setIdentity();
    rows.block<3, 3>(3 * i, 3) = skew(arm);
  }
  return rows;
}

Eigen::MatrixXd mean_rows(const InterfaceSet& set, const Eigen::Matrix3Xd& positions) {
  const Eigen::MatrixXd rigid = rigid_rows(set, positions);
  const PivotedQr columns(rigid, 1e-9);
  if (columns.rank() < 6) {
    throw InputError(
        fmt::format("the {} nodes of \"{}\" are on one line: they have no mean "
                    "rotation; choose more nodes",
                    set.nodes.size(), set.name));
  }
  return Cholesky(rigid.transpose() * rigid).solve(rigid.transpose());
}

Eigen::MatrixXd mean_motion(const InterfaceSet& set, const Eigen::Matrix3Xd& positions,
                            const Eigen::MatrixXd& shape) {
  const Eigen::MatrixXd rows = mean_rows(set, positions);
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(6, shape.cols());
  for (int i = 0; i < int_size(set.nodes); ++i) {
    motion += rows.middleCols<3>(3 * i) * shape.middleRows<3>(3 * set.nodes[i]);
  }
  return motion;
}

Eigen::Vector3d centroid_of(const std::vector<int>& nodes, const Eigen::Matrix3Xd& positions) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int node : nodes) sum += positions.col(node);
  return sum / double(nodes.size());
}

namespace {

/// Of the six coordinates of an interface, displacements before rotations.
bool is_in_plane(int coordinate, int normal) {
  const int direction = coordinate % 3;
  return coordinate % 6 < 3 ? direction != normal : direction == normal;
}

/// How strongly a mode couples with motions in the plane, and with others: squares, relative to the
/// inertia of these motions.
struct Couplings {
  double inside = 0.0, across = 0.0;

  void add(bool is_inside, double coupling, double inertia) {
    if (inertia > 0.0) (is_inside ? inside : across) += coupling * coupling / inertia;
  }
};

Couplings couplings_of(const BodyConstants& constants, int mode, int normal, int prescribed) {
  Couplings couplings;
  for (int k = 0; k < 3; ++k) {
    couplings.add(k != normal, constants.shape.coeff(k, mode), constants.mass);
    for (int l = 0; l < 3; ++l) {
      couplings.add((k == normal) == (l == normal), constants.mixed.coeff(3 * k + l, mode),
                    constants.second_moment(k, k));
    }
  }
  for (int i = 0; i < prescribed; ++i) {
    couplings.add(is_in_plane(i, normal), constants.mass_matrix.coeff(i, mode),
                  constants.mass_matrix.coeff(i, i));
  }
  return couplings;
}

/// Sets entries of rows to zero. @returns the largest of them, relative to the largest entry
template <class Condition>
double clear_rows(SparseMatrix& matrix, const Condition& is_across) {
  Eigen::MatrixXd dense(matrix);
  const double size = dense.size() > 0 ? dense.cwiseAbs().maxCoeff() : 0.0;
  double largest = 0.0;
  for (Eigen::Index row = 0; row < dense.rows(); ++row) {
    if (!is_across(static_cast<int>(row))) continue;
    largest = std::max(largest, dense.row(row).cwiseAbs().maxCoeff());
    dense.row(row).setZero();
  }
  matrix = sparse_of(dense);
  return size > 0.0 ? largest / size : 0.0;
}

double clear_moments(BodyConstants& constants, int normal) {
  double largest = 0.0;
  const double size = Eigen::MatrixXd(constants.mass_matrix).cwiseAbs().maxCoeff();
  for (std::size_t p = 0; p < moment_pairs.size(); ++p) {
    const auto [k, l] = moment_pairs[p];
    if ((k == normal) == (l == normal)) continue;
    largest = std::max(largest, Eigen::MatrixXd(constants.moments[p]).cwiseAbs().maxCoeff() / size);
    constants.moments[p].setZero();
  }
  return largest;
}

}  // namespace

std::vector<int> coordinates_in_plane(const BodyConstants& constants, int normal, int prescribed) {
  std::vector<int> kept;
  for (int i = 0; i < constants.size(); ++i) {
    if (i < prescribed) {
      if (is_in_plane(i, normal)) kept.push_back(i);
      continue;
    }
    const Couplings couplings = couplings_of(constants, i, normal, prescribed);
    if (couplings.inside > couplings.across) kept.push_back(i);
  }
  return kept;
}

double clear_across_plane(BodyConstants& constants, int normal) {
  double largest = clear_rows(constants.shape, [&](int row) { return row == normal; });
  largest = std::max(largest, clear_rows(constants.mixed, [&](int row) {
                       return (row / 3 == normal) != (row % 3 == normal);
                     }));
  largest = std::max(largest, clear_moments(constants, normal));
  for (BodyPlace& place : constants.places) {
    largest = std::max(largest, clear_rows(place.displacement, [&](int k) { return k == normal; }));
    clear_rows(place.rotation, [&](int k) { return k != normal; });
  }
  for (int k = 0; k < 3; ++k) {
    if (k == normal) continue;
    const double size = constants.second_moment.cwiseAbs().maxCoeff();
    largest = std::max(largest, std::abs(constants.second_moment(k, normal)) / size);
    constants.second_moment(k, normal) = constants.second_moment(normal, k) = 0.0;
  }
  constants.first_moment(normal) = 0.0;
  return largest;
}

}  // namespace pleuel
