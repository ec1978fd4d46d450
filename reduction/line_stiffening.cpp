#include "reduction/line_stiffening.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "reduction/nodal_invariants.hpp"

namespace pleuel {

namespace {

/// Rows: along the line, and two directions across it.
Eigen::Matrix3d line_axes(const Eigen::Vector3d& along) {
  Eigen::Matrix3d axes;
  const Eigen::Vector3d first = along.normalized();
  Eigen::Index least = 0;
  first.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d third = first.cross(Eigen::Vector3d::Unit(least)).normalized();
  axes << first.transpose(), third.cross(first).transpose(), third.transpose();
  return axes;
}

/// Nodes next to a cross-section of the line, as a set around the point of the line.
InterfaceSet section_at(const StiffeningLine& line, const Eigen::Matrix3Xd& positions,
                        double part) {
  const Eigen::Vector3d along = line.end.at - line.begin.at;
  InterfaceSet set{fmt::format("the cross-section at {:.3g} of the line of stiffening", part),
                   {},
                   line.begin.at + part * along,
                   false};
  for (int node = 0; node < static_cast<int>(positions.cols()); ++node) {
    const double place = along.dot(positions.col(node) - line.begin.at) / along.squaredNorm();
    // Nodes halfway belong to both: round-off decides over none.
    if (std::abs(place - part) <= 0.500001 / line.elements) set.nodes.push_back(node);
  }
  if (set.nodes.size() < 3) {
    throw InputError(fmt::format("{} has {} nodes around it: take fewer elements than {}", set.name,
                                 set.nodes.size(), line.elements));
  }
  return set;
}

/// Displacements of all stations per coordinate in the axes of the line, three rows each.
Eigen::MatrixXd station_rows(const StiffeningLine& line, const Eigen::Matrix3Xd& positions,
                             const Eigen::MatrixXd& shape) {
  const Eigen::Matrix3d axes = line_axes(line.end.at - line.begin.at);
  Eigen::MatrixXd rows(3 * (line.elements + 1), shape.cols());
  for (int i = 0; i <= line.elements; ++i) {
    const InterfaceSet section = i == 0 ? line.begin
                                 : i == line.elements
                                     ? line.end
                                     : section_at(line, positions, double(i) / line.elements);
    rows.middleRows<3>(3 * i) = axes * mean_motion(section, positions, shape).topRows<3>();
  }
  return rows;
}

Eigen::MatrixXd slopes_of(double length) {
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(6, 6);
  for (int k = 1; k < 3; ++k) {
    slopes(k, k) = slopes(k + 3, k + 3) = 1.0 / length;
    slopes(k, k + 3) = slopes(k + 3, k) = -1.0 / length;
  }
  return slopes;
}

}  // namespace

Stretching line_stiffening(const StiffeningLine& line, const Eigen::Matrix3Xd& positions,
                           const Eigen::MatrixXd& shape, const Eigen::MatrixXd& stiffness) {
  const Eigen::MatrixXd rows = station_rows(line, positions, shape);
  const Eigen::VectorXd end = (rows.row(3 * line.elements) - rows.row(0)).transpose();
  const Eigen::VectorXd stretched = rows * Eigen::MatrixXd(Cholesky(stiffness).solve(end));
  const double length = (line.end.at - line.begin.at).norm() / line.elements;
  Stretching stretching;
  stretching.damping = line.damping;
  stretching.displacements = sparse_of(rows);
  for (int i = 0; i < line.elements; ++i) {
    const double elongation = stretched(3 * i + 3) - stretched(3 * i);
    if (!(elongation > 0.0)) {
      throw InputError(
          fmt::format("part {} of {} of the line from \"{}\" to \"{}\" gets no longer "
                      "under tension: take fewer elements of stiffening",
                      i + 1, line.elements, line.begin.name, line.end.name));
    }
    StretchedElement element;
    for (int k = 0; k < 6; ++k) element.displacements.push_back(3 * i + k);
    element.elongation = Eigen::VectorXd::Zero(6);
    element.elongation(0) = -1.0;
    element.elongation(3) = 1.0;
    element.axial_stiffness = 1.0 / elongation;
    element.slopes = slopes_of(length);
    stretching.elements.push_back(std::move(element));
  }
  return stretching;
}

}  // namespace pleuel
