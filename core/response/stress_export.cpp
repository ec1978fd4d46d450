#include "core/response/stress_export.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/model/body_point.hpp"
#include "core/response/body_strengths.hpp"
#include "core/response/section_forces.hpp"
#include "core/response/stress_signal.hpp"
#include "core/scene/beam_mesh.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/response_kind.hpp"

namespace pleuel {

namespace {

/// Where the scene and the responses hold on to a beam.
class PlaceFinder {
 public:
  PlaceFinder(const ProblemFile& problem, const BodyModel& body) : body_(body) {
    for (const DesignVariable& variable : problem.variables) start_.push_back(variable.start);
    beam_ = &std::get<BeamBody>(find_named(problem.scene.bodies, body.name)->shape);
    for (const AttachedPoint& point : attached_points(problem.scene, body.name)) {
      add(point.name, held_place(body, share_along(*beam_, point.at, start_)));
    }
    for (const ResponseSettings& response : problem.responses) add_response(response);
    for (int node = 0; node < body.beam.node_count(); ++node) {
      add(fmt::format("node {}", node),
          node == 0 ? BeamPlace{{0, 0.0}} : BeamPlace{{node - 1, 1.0}});
    }
    std::stable_sort(places_.begin(), places_.end(),
                     [](const NamedPlace& a, const NamedPlace& b) { return a.x < b.x; });
  }

  std::vector<NamedPlace> take() { return std::move(places_); }

 private:
  void add_response(const ResponseSettings& response) {
    if (!kind_of(response.type).is_of_point || response.bodies.front() != body_.name) return;
    add(response.name, place_at(body_, response.at));
  }

  void add(const std::string& name, const BeamPlace& place) {
    const double x = position_of(body_.beam, place);
    const double length = body_.beam.node_position(body_.beam.node_count() - 1);
    bool has_name = false;
    for (const NamedPlace& other : places_) {
      if (std::abs(other.x - x) < 1e-9 * length) return;
      has_name = has_name || other.name == name;
    }
    places_.push_back({has_name ? fmt::format("{} at {:.6g}", name, x / length) : name, place, x});
  }

  const BodyModel& body_;
  const BeamBody* beam_ = nullptr;
  Design<double> start_;
  std::vector<NamedPlace> places_;
};

/// Points on a round outline in space, where the place of the largest stress moves: the largest of
/// them is too small by 1 − cos(π/32) = 0.5 % of the bending stress at most.
constexpr int outline_points = 32;

}  // namespace

std::vector<NamedPlace> named_places(const ProblemFile& problem, const BodyModel& body) {
  return PlaceFinder(problem, body).take();
}

StressExport::StressExport(const BodyModel& body, const std::vector<NamedPlace>& places)
    : body_(body), places_(places), stations_(find_stations(body, {})) {
  find_stress_places();
}

void StressExport::find_stress_places() {
  const bool is_planar = body_.frame.rotation == RotationCoordinates::angle;
  for (int s = 0; s < int_size(stations_); ++s) {
    const std::string node = describe(stations_[s], body_);
    const SectionProperties<double>& section = section_of(body_.beam, s);
    if (section.is_round() && !is_planar) {
      for (int i = 0; i < outline_points; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / outline_points;
        stress_places_.push_back(
            {fmt::format("{}, outline at {:g} rad", node, angle), s, -1, angle});
      }
      continue;
    }
    for (int point : distinct_stress_points(body_, section)) {
      const auto& at = section.points[point];
      stress_places_.push_back(
          {fmt::format("{}, y = {:.4g} m, z = {:.4g} m", node, at.y, at.z), s, point});
    }
  }
}

template <class Scalar>
StressPoint<Scalar> StressExport::point_of(const SectionProperties<Scalar>& section,
                                           const StressPlace& place) {
  if (place.point >= 0) return section.points[place.point];
  using std::sqrt;
  const double c = std::cos(place.angle), s = std::sin(place.angle);
  const Scalar &shear_y = section.points[0].shear, &shear_z = section.points[2].shear;
  return {section.radius_y * c, section.radius_z * s,
          sqrt(c * c * shear_y * shear_y + s * s * shear_z * shear_z)};
}

/// σ_xx and τ_xy of all points from the section forces of all stations, six rows a point.
/// @param number  Scalar → double: value or derivative
template <class Scalar, class Number>
SparseMatrix StressExport::stress_of_forces(const Beam<Scalar>& beam, const Number& number) const {
  std::vector<Eigen::Triplet<double>> entries;
  int row = 0;
  for (const StressPlace& place : stress_places_) {
    const SectionProperties<Scalar>& section = section_of(beam, place.station);
    const StressPoint<Scalar> point = point_of(section, place);
    const Scalar normal[] = {1.0 / section.area, point.z / section.inertia_y,
                             -point.y / section.inertia_z};
    const int column = section_force_count * place.station;
    for (int i = 0; i < 3; ++i) entries.emplace_back(row, column + i, number(normal[i]));
    entries.emplace_back(row + 3, column + 3, number(point.shear));
    row += 6;
  }
  SparseMatrix matrix(row, section_force_count * static_cast<Eigen::Index>(stations_.size()));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

SparseMatrix StressExport::stress_of_forces() const {
  return stress_of_forces(body_.beam, [](double number) { return number; });
}

/// Accelerations of the nodes as those of the named places.
SparseMatrix StressExport::of_named_places(const SparseMatrix& of_nodes) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (int node = 0; node < body_.beam.node_count(); ++node) {
    const double x = body_.beam.node_position(node);
    const auto nearest = std::min_element(places_.begin(), places_.end(),
                                          [x](const NamedPlace& a, const NamedPlace& b) {
                                            return std::abs(a.x - x) < std::abs(b.x - x);
                                          });
    for (int i = 0; i < 3; ++i) {
      entries.emplace_back(3 * node + i, 3 * (nearest - places_.begin()) + i, 1.0);
    }
  }
  SparseMatrix nodes(of_nodes.cols(), 3 * static_cast<Eigen::Index>(places_.size()));
  nodes.setFromTriplets(entries.begin(), entries.end());
  return of_nodes * nodes;
}

/// One for each segment, where there are several.
std::vector<PointGroup> StressExport::segment_groups() const {
  const std::vector<MeshElement>& elements = body_.mesh.elements;
  std::vector<PointGroup> groups(static_cast<std::size_t>(elements.back().segment) + 1);
  if (groups.size() == 1) return {};
  for (std::size_t i = 0; i < groups.size(); ++i) groups[i].name = fmt::format("segment {}", i);
  for (int i = 0; i < int_size(stress_places_); ++i) {
    const int element = stations_[stress_places_[i].station].elements.front();
    groups[elements[element].segment].points.push_back(i);
  }
  return groups;
}

StressRecovery StressExport::recovery_of(const Recovery& stress,
                                         const Strengths<double>& strengths) const {
  StressRecovery recovery;
  for (const StressPlace& place : stress_places_) recovery.points.push_back(place.name);
  recovery.groups = segment_groups();
  recovery.strengths = strengths;
  recovery.of_coordinates = stress.of_coordinates.pruned();
  recovery.of_accelerations = of_named_places(stress.of_accelerations).pruned();
  recovery.of_stretching = stress.of_stretching.pruned();
  return recovery;
}

StressRecovery StressExport::value() const {
  const SparseMatrix stress = stress_of_forces();
  const Recovery forces = section_force_recovery(body_, stations_);
  return recovery_of({stress * forces.of_coordinates, stress * forces.of_accelerations,
                      stress * forces.of_stretching},
                     body_.beam.elements.front().strengths);
}

StressRecovery StressExport::derivative(std::size_t k) const {
  const Beam<Dual>& beam = body_.beam_x[k].second;
  const SparseMatrix stress = stress_of_forces();
  const SparseMatrix stress_x =
      stress_of_forces(beam, [](const Dual& number) { return derivative_of(number); });
  const Recovery forces = section_force_recovery(body_, stations_);
  const Recovery forces_x = section_force_derivative(body_, stations_, k);
  const auto change = [&](const SparseMatrix Recovery::*part) {
    return SparseMatrix(SparseMatrix(stress * (forces_x.*part)) +
                        SparseMatrix(stress_x * (forces.*part)));
  };
  return recovery_of({change(&Recovery::of_coordinates), change(&Recovery::of_accelerations),
                      change(&Recovery::of_stretching)},
                     derivative_of(beam.elements.front().strengths));
}

}  // namespace pleuel
