#include "core/trust/lateral_stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "core/beam/beam_shape.hpp"
#include "core/beam/natural_modes.hpp"

namespace pleuel {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Row6 = Eigen::Matrix<double, 1, 6>;

/// Rows in w, w', φ of both nodes.
Row6 deflection_row(double xi, double length, int order) {
  const auto h = hermite(xi, length, order);
  Row6 row = Row6::Zero();
  row(0) = h[0];
  row(1) = h[1];
  row(3) = h[2];
  row(4) = h[3];
  return row;
}

struct ElementMatrices {
  Matrix6 elastic = Matrix6::Zero(), geometric = Matrix6::Zero();
};

ElementMatrices element_matrices(const BeamElement<double>& element, BendingPlane plane,
                                 double axial, const std::array<double, 2>& moment) {
  const SectionProperties<double>& section = element.section;
  const double length = element.length;
  const bool is_xy = plane == BendingPlane::xy;
  const double lateral = is_xy ? section.inertia_y : section.inertia_z;
  const double bending = is_xy ? section.inertia_z : section.inertia_y;
  const double m = std::sqrt(std::max(0.0, 1.0 - lateral / bending));
  const double polar = (section.inertia_y + section.inertia_z) / section.area;
  Row6 twist_slope = Row6::Zero();
  twist_slope(2) = -1.0 / length;
  twist_slope(5) = 1.0 / length;
  ElementMatrices matrices;
  for (const GaussPoint& point : gauss_points) {
    const double weight = point.weight * length;
    const Row6 slope = deflection_row(point.xi, length, 1);
    const Row6 curvature = deflection_row(point.xi, length, 2);
    Row6 twist = Row6::Zero();
    twist(2) = 1.0 - point.xi;
    twist(5) = point.xi;
    const double at = m * ((1.0 - point.xi) * moment[0] + point.xi * moment[1]);
    const Matrix6 coupling = twist.transpose() * curvature;
    matrices.elastic +=
        weight * (element.young * lateral * curvature.transpose() * curvature +
                  element.shear * section.torsion * twist_slope.transpose() * twist_slope);
    matrices.geometric +=
        weight *
        (axial * (slope.transpose() * slope + polar * twist_slope.transpose() * twist_slope) +
         at * (coupling + coupling.transpose()));
  }
  return matrices;
}

/// The rows of what the supports leave free.
std::vector<Eigen::Index> free_rows(const std::vector<LateralSupport>& supports) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < supports.size(); ++i) {
    const auto first = static_cast<Eigen::Index>(3 * i);
    if (!supports[i].deflection) rows.push_back(first);
    if (!supports[i].slope) rows.push_back(first + 1);
    if (!supports[i].twist) rows.push_back(first + 2);
  }
  return rows;
}

}  // namespace

double lateral_load_factor(const Beam<double>& beam, BendingPlane plane,
                           const std::vector<LateralSupport>& supports, const PlaneLoad& load) {
  const Eigen::Index size = 3 * beam.node_count();
  Eigen::MatrixXd elastic = Eigen::MatrixXd::Zero(size, size), geometric = elastic;
  for (std::size_t e = 0; e < beam.elements.size(); ++e) {
    const auto first = static_cast<Eigen::Index>(3 * e);
    const ElementMatrices matrices =
        element_matrices(beam.elements[e], plane, load.axial[e], load.moment[e]);
    elastic.block<6, 6>(first, first) += matrices.elastic;
    geometric.block<6, 6>(first, first) += matrices.geometric;
  }
  const std::vector<Eigen::Index> rows = free_rows(supports);
  if (rows.empty()) return std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd k = elastic(rows, rows);
  // Lengths and angles alike: rows as large as their diagonal.
  const Eigen::VectorXd scale = k.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * k * scale.asDiagonal();
  constexpr double singular = 1e-12;
  const Eigen::LDLT<Eigen::MatrixXd> factors(scaled);
  if (factors.info() != Eigen::Success || factors.vectorD().minCoeff() < singular) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  // −G φ = (1/s) K φ
  const Eigen::MatrixXd destabilizing =
      -(scale.asDiagonal() * geometric(rows, rows) * scale.asDiagonal());
  const double largest = natural_modes(destabilizing, scaled).lambda.maxCoeff();
  return largest > 0.0 ? 1.0 / largest : std::numeric_limits<double>::infinity();
}

}  // namespace pleuel
