#include "core/response/stress_export.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/response/element_forces.hpp"
#include "core/response/stress_signal.hpp"

namespace pleuel {

using Eigen::MatrixXd;

namespace {

/// Points on a round outline in space, where the place of the largest stress moves: the largest of
/// them is too small by 1 − cos(π/32) = 0.5 % of the bending stress at most.
constexpr int outline_points = 32;

}  // namespace

StressExport::StressExport(const BodyModel& body, const std::vector<NamedPlace>& places)
    : body_(body), nodal_(body), places_(places), stations_(find_stations(body, {})) {
  find_stress_places();
}

const SectionProperties<double>& StressExport::section_of(int station) const {
  const int element = stations_[static_cast<std::size_t>(station)].elements.front();
  return body_.beam.elements[static_cast<std::size_t>(element)].section;
}

void StressExport::find_stress_places() {
  const bool is_planar = body_.frame.rotation == RotationCoordinates::angle;
  for (int s = 0; s < static_cast<int>(stations_.size()); ++s) {
    const std::string node = fmt::format("node {}", stations_[static_cast<std::size_t>(s)].place);
    const SectionProperties<double>& section = section_of(s);
    if (section.is_round() && !is_planar) {
      for (int i = 0; i < outline_points; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / outline_points;
        stress_places_.push_back(
            {fmt::format("{}, outline at {:g} rad", node, angle), s, -1, angle});
      }
      continue;
    }
    for (int point : distinct_stress_points(body_, section)) {
      const auto& at = section.points[static_cast<std::size_t>(point)];
      stress_places_.push_back(
          {fmt::format("{}, y = {:.4g} m, z = {:.4g} m", node, at.y, at.z), s, point});
    }
  }
}

template <class Scalar>
StressPoint<Scalar> StressExport::point_of(const SectionProperties<Scalar>& section,
                                           const StressPlace& place) {
  if (place.point >= 0) return section.points[static_cast<std::size_t>(place.point)];
  using std::sqrt;
  const double c = std::cos(place.angle), s = std::sin(place.angle);
  const Scalar &shear_y = section.points[0].shear, &shear_z = section.points[2].shear;
  return {section.radius_y * c, section.radius_z * s,
          sqrt(c * c * shear_y * shear_y + s * s * shear_z * shear_z)};
}

/// σ_xx and τ of a point per unit of: twelve coordinates of an element, elongation, three
/// accelerations of either node.
template <class Scalar>
Eigen::Matrix<Scalar, 2, 19> StressExport::unit_stresses(const BeamElement<Scalar>& element,
                                                         const SectionProperties<Scalar>& section,
                                                         const StressPlace& place, double xi) {
  const StressPoint<Scalar> point = point_of(section, place);
  Eigen::Matrix<Scalar, 2, 19> columns;
  for (int i = 0; i < 19; ++i) {
    Eigen::Matrix<Scalar, 19, 1> unit = Eigen::Matrix<Scalar, 19, 1>::Constant(Scalar(0));
    unit(i) = Scalar(1);
    const SectionForces<Scalar> forces =
        element_forces<Scalar>(element, unit.template head<12>(), unit(12),
                               {unit.template segment<3>(13), unit.template segment<3>(16)}, xi);
    columns(0, i) = forces.axial / section.area - forces.moment_z * point.y / section.inertia_z +
                    forces.moment_y * point.z / section.inertia_y;
    columns(1, i) = forces.torque * point.shear;
  }
  return columns;
}

int StressExport::place_of_node(int node) const {
  const double x = body_.beam.node_position(node);
  const auto nearest = std::min_element(places_.begin(), places_.end(),
                                        [x](const NamedPlace& a, const NamedPlace& b) {
                                          return std::abs(a.x - x) < std::abs(b.x - x);
                                        });
  return static_cast<int>(nearest - places_.begin());
}

/// @param number  Scalar → double: value or derivative
template <class Scalar, class Number>
StressExport::Rows StressExport::rows_of(const Beam<Scalar>& beam, const Number& number) const {
  const auto rows = 6 * static_cast<Eigen::Index>(stress_places_.size());
  const auto elements = static_cast<Eigen::Index>(beam.elements.size());
  Rows result{MatrixXd::Zero(rows, nodal_.nodal_size()),
              MatrixXd::Zero(rows, 3 * static_cast<Eigen::Index>(places_.size())),
              MatrixXd::Zero(rows, elements)};
  for (std::size_t i = 0; i < stress_places_.size(); ++i) {
    const Station& station = stations_[static_cast<std::size_t>(stress_places_[i].station)];
    const auto& section = beam.elements[static_cast<std::size_t>(station.elements.front())].section;
    const double share = 1.0 / static_cast<double>(station.elements.size());
    for (int e : station.elements) {
      const BeamElement<Scalar>& element = beam.elements[static_cast<std::size_t>(e)];
      const auto unit =
          unit_stresses<Scalar>(element, section, stress_places_[i], station.place - e);
      MatrixXd columns(2, 19);
      for (int c = 0; c < 19; ++c) {
        for (int r = 0; r < 2; ++r) columns(r, c) = share * number(unit(r, c));
      }
      add_element(static_cast<Eigen::Index>(6 * i), e, columns, result);
      // A force N instead of the strain: σ = N/A.
      result.of_stretching(static_cast<Eigen::Index>(6 * i), e) =
          share * number(Scalar(1.0 / section.area));
    }
  }
  return result;
}

void StressExport::add_element(Eigen::Index row, int e, const MatrixXd& columns, Rows& rows) const {
  MatrixXd strain = columns.leftCols(12);
  strain.col(0) -= columns.col(12);
  strain.col(6) += columns.col(12);
  const MatrixXd nodal = nodal_.scatter(e, strain);
  for (int r = 0; r < 2; ++r) {  // σ_xx and τ_xy of six
    const Eigen::Index at = row + (r == 0 ? 0 : 3);
    rows.of_nodal.row(at) += nodal.row(r);
    for (int end : {0, 1}) {
      rows.of_accelerations.row(at).segment(3 * place_of_node(e + end), 3) +=
          columns.row(r).segment(13 + 3 * end, 3);
    }
  }
}

StressRecovery StressExport::recovery_of(const Rows& rows, const MatrixXd& of_coordinates) const {
  StressRecovery recovery;
  for (const StressPlace& place : stress_places_) recovery.points.push_back(place.name);
  recovery.of_coordinates = of_coordinates.sparseView();
  recovery.of_accelerations = rows.of_accelerations.sparseView();
  if (body_.has_stiffening) {
    recovery.of_stretching = rows.of_stretching.sparseView();
  } else {
    recovery.of_stretching.resize(rows.of_stretching.rows(), 0);
  }
  return recovery;
}

StressExport::Rows StressExport::values() const {
  return rows_of(body_.beam, [](double number) { return number; });
}

StressRecovery StressExport::value() const {
  const Rows rows = values();
  StressRecovery recovery = recovery_of(rows, nodal_.reduce(rows.of_nodal));
  recovery.strength = body_.beam.elements.front().strength;
  return recovery;
}

StressRecovery StressExport::derivative(std::size_t k) const {
  const Beam<Dual>& beam = body_.beam_x[k].second;
  const Rows rows = rows_of(beam, [](const Dual& number) { return derivative_of(number); });
  const MatrixXd of_coordinates = nodal_.reduce_derivative(values().of_nodal, rows.of_nodal, k);
  StressRecovery recovery = recovery_of(rows, of_coordinates);
  recovery.strength = derivative_of(beam.elements.front().strength);
  return recovery;
}

}  // namespace pleuel
