#include "core/response/body_export.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/model/body_point.hpp"
#include "core/model/imported_constants.hpp"
#include "core/response/body_strengths.hpp"
#include "core/response/section_forces.hpp"
#include "core/response/stress_signal.hpp"
#include "core/scene/beam_mesh.hpp"
#include "core/scene/held_points.hpp"

namespace pleuel {

namespace {

SparseMatrix sparse(const Eigen::MatrixXd& matrix) {
  return matrix.sparseView();
}

template <class Entries>
SparseMatrix sparse(const ElasticPattern& pattern, const Entries& entries) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (int row = 0; row < pattern.size; ++row) {
    for (int i = pattern.row_start[row]; i < pattern.row_start[static_cast<std::size_t>(row) + 1];
         ++i) {
      if (entries(i) == 0.0) continue;
      triplets.emplace_back(row, pattern.column[i], entries(i));
    }
  }
  SparseMatrix matrix(pattern.size, pattern.size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

/// Without the round-off by which derivatives that vanish would not be symmetric.
SparseMatrix symmetric(const ElasticPattern& pattern, const Eigen::VectorXd& entries) {
  const SparseMatrix matrix = sparse(pattern, entries);
  return 0.5 * (matrix + SparseMatrix(matrix.transpose()));
}

BodyConstants constants_of(const Invariants<double>& invariants) {
  BodyConstants constants;
  const ElasticPattern& pattern = invariants.pattern;
  constants.mass = invariants.mass;
  constants.first_moment = invariants.first_moment;
  constants.second_moment = invariants.second_moment;
  constants.shape = sparse(invariants.shape);
  constants.mixed = sparse(invariants.mixed);
  constants.mass_matrix = symmetric(pattern, invariants.mass_matrix);
  constants.stiffness = symmetric(pattern, invariants.stiffness);
  constants.damping = symmetric(pattern, invariants.damping);
  for (std::size_t i = 0; i < moment_pairs.size(); ++i) {
    constants.moments[i] = SparseMatrix(pattern.size, pattern.size);
    const auto found = std::ranges::find(invariants.pairs, moment_pairs[i]);
    if (found == invariants.pairs.end()) continue;
    constants.moments[i] =
        sparse(pattern, invariants.moments.col(found - invariants.pairs.begin()));
  }
  return constants;
}

BodyPlace body_place(const std::string& name, const PointShape& point) {
  return {name, point.position, point.shape.topRows(3), point.shape.bottomRows(3)};
}

/// Of a beam.
struct NamedPlace {
  std::string name;
  BeamPlace place;
  double x = 0.0;  ///< along the beam [m]
};

/// The nodes of a beam, and where the scene and the responses hold on to it.
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
    std::ranges::stable_sort(places_,
                             [](const NamedPlace& a, const NamedPlace& b) { return a.x < b.x; });
  }

  std::vector<NamedPlace> take() { return std::move(places_); }

 private:
  void add_response(const ResponseSettings& response) {
    const auto* point = response_point(response);
    if (point == nullptr || point->body != body_.name) return;
    add(response.name, place_at(body_, point->at));
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

/// Stress of a beam as matrices: of its coordinates, of accelerations of its places, and of the
/// forces of its stretched members (core/scene/body_constants.hpp). Body and places must outlive
/// it.
class StressExport {
 public:
  /// @param places  all nodes among them
  StressExport(const BodyModel& body, const std::vector<NamedPlace>& places)
      : body_(body), places_(places), stations_(find_stations(body, {})) {
    find_stress_places();
  }

  StressRecovery value() const {
    const SparseMatrix stress = stress_of_forces();
    const Recovery forces = section_recovery(body_, stations_, section_force_parts);
    return recovery_of({stress * forces.of_coordinates, stress * forces.of_accelerations,
                        stress * forces.of_stretching},
                       body_.beam.elements.front().strengths);
  }

  /// @param k  in the order of BodyModel::beam_x
  StressRecovery derivative(std::size_t k) const {
    const Beam<Dual>& beam = body_.beam_x[k].second;
    const SparseMatrix stress = stress_of_forces();
    const SparseMatrix stress_x =
        stress_of_forces(beam, [](const Dual& number) { return derivative_of(number); });
    const Recovery forces = section_recovery(body_, stations_, section_force_parts);
    const Recovery forces_x = section_recovery_derivative(body_, stations_, section_force_parts, k);
    const auto change = [&](const SparseMatrix Recovery::*part) {
      return SparseMatrix(SparseMatrix(stress * (forces_x.*part)) +
                          SparseMatrix(stress_x * (forces.*part)));
    };
    return recovery_of({change(&Recovery::of_coordinates), change(&Recovery::of_accelerations),
                        change(&Recovery::of_stretching)},
                       derivative_of(beam.elements.front().strengths));
  }

 private:
  /// A point of one station.
  struct StressPlace {
    std::string name;
    int station;
    int point;           ///< of the section, or −1: on its outline
    double angle = 0.0;  ///< on the outline

    template <class Scalar>
    StressPoint<Scalar> at(const SectionProperties<Scalar>& section) const {
      return point >= 0 ? section.points[point] : outline_point(section, angle);
    }
  };

  template <class Scalar>
  const SectionProperties<Scalar>& section_of(const Beam<Scalar>& beam, int station) const {
    return beam.elements[stations_[station].elements.front()].section;
  }

  void find_stress_places() {
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

  /// σ_xx and τ_xy of all points from the section forces of all stations, six rows a point.
  /// @param number  Scalar → double: value or derivative
  template <class Scalar, class Number>
  SparseMatrix stress_of_forces(const Beam<Scalar>& beam, const Number& number) const {
    std::vector<Eigen::Triplet<double>> entries;
    int row = 0;
    for (const StressPlace& place : stress_places_) {
      const SectionProperties<Scalar>& section = section_of(beam, place.station);
      const StressPoint<Scalar> point = place.at(section);
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

  SparseMatrix stress_of_forces() const {
    return stress_of_forces(body_.beam, [](double number) { return number; });
  }

  /// Accelerations of the nodes as those of the named places.
  SparseMatrix of_named_places(const SparseMatrix& of_nodes) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (int node = 0; node < body_.beam.node_count(); ++node) {
      const double x = body_.beam.node_position(node);
      const auto nearest =
          std::ranges::min_element(places_, [x](const NamedPlace& a, const NamedPlace& b) {
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
  std::vector<PointGroup> segment_groups() const {
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

  StressRecovery recovery_of(const Recovery& stress, const Strengths<double>& strengths) const {
    StressRecovery recovery;
    for (const StressPlace& place : stress_places_) recovery.points.push_back(place.name);
    recovery.groups = segment_groups();
    recovery.strengths = strengths;
    recovery.of_coordinates = stress.of_coordinates.pruned();
    recovery.of_accelerations = of_named_places(stress.of_accelerations).pruned();
    recovery.of_stretching = stress.of_stretching.pruned();
    return recovery;
  }

  const BodyModel& body_;
  const std::vector<NamedPlace>& places_;
  std::vector<Station> stations_;
  std::vector<StressPlace> stress_places_;
};

class BeamExport {
 public:
  BeamExport(const ProblemFile& problem, const BodyModel& body)
      : body_(body), places_(PlaceFinder(problem, body).take()), stress_(body, places_) {
    for (const NamedPlace& place : places_) points_.push_back(point_of(body, place.place));
  }

  BodyConstants constants() const {
    BodyConstants constants = constants_of(body_.invariants);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      constants.places.push_back(body_place(places_[i].name, points_[i]));
    }
    if (body_.has_stiffening) constants.stretching = body_.stretching;
    constants.stress = stress_.value();
    return constants;
  }

  /// @param k  in the order of beam_x
  BodyConstants derivative(std::size_t k) const {
    BodyConstants change = constants_of(body_.invariants_x[k].data);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      change.places.push_back(body_place(places_[i].name, points_[i].derivatives[k].data));
    }
    if (body_.has_stiffening) change.stretching = body_.stretching_x[k].data;
    change.stress = stress_.derivative(k);
    return change;
  }

 private:
  const BodyModel& body_;
  std::vector<NamedPlace> places_;
  std::vector<BodyPoint> points_;
  StressExport stress_;
};

std::vector<std::string> coordinate_names(const BodyModel& body) {
  constexpr std::array<const char*, 6> displacements = {"u", "v", "w", "θx", "θy", "θz"};
  std::vector<std::string> names(body.elastic_size());
  if (body.has_basis) {
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = fmt::format("mode {}", i + 1);
    return names;
  }
  for (int node = 0; node < body.coordinates.node_count(); ++node) {
    for (int i = 0; i < 6; ++i) {
      const int index = body.coordinates.index(node, i);
      if (index < 0) continue;
      names[index] = fmt::format("{} of node {}", displacements[i], node);
    }
  }
  return names;
}

/// An imported body goes on as it came, at the design of the model.
InvariantsFile pass_on(const ImportedBody& imported, const Body& body, const ProblemFile& problem) {
  Design<double> start;
  for (const DesignVariable& variable : problem.variables) start.push_back(variable.start);
  InvariantsFile file = *body_at(imported, body, start);
  file.body = body.name;
  return file;
}

}  // namespace

InvariantsFile export_body(const ProblemFile& problem, const Model& model, const std::string& name,
                           const std::vector<std::string>& units) {
  const BodyModel& body = model.body(name);
  const Body* source = find_named(problem.scene.bodies, name);
  if (!body.is_elastic) {
    throw InputError(fmt::format("the body \"{}\" is rigid: it has no elastic coordinates", name));
  }
  if (const auto* imported = std::get_if<ImportedBody>(&source->shape)) {
    return pass_on(*imported, *source, problem);
  }
  const BeamExport beam(problem, body);
  InvariantsFile file;
  file.body = name;
  file.description = fmt::format("of the problem {}", problem.name);
  file.reference_condition = word_of(reference_conditions, std::get<BeamBody>(source->shape).frame);
  file.coordinates = coordinate_names(body);
  file.constants = beam.constants();
  for (std::size_t k = 0; k < body.beam_x.size(); ++k) {
    const std::size_t variable = body.beam_x[k].first;
    file.design.push_back({problem.variables[variable].name, problem.variables[variable].start,
                           units[variable], beam.derivative(k)});
  }
  return file;
}

}  // namespace pleuel
