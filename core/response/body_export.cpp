#include "core/response/body_export.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/beam/beam_place.hpp"
#include "core/model/beam_builder.hpp"
#include "core/response/element_forces.hpp"
#include "core/response/station.hpp"
#include "core/response/stress_signal.hpp"

namespace pleuel {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Points on a round outline in space, where the place of the largest stress moves: the largest of
/// them is too small by 1 − cos(π/32) = 0.5 % of the bending stress at most.
constexpr int outline_points = 32;

SparseMatrix sparse(const MatrixXd& matrix) {
  return matrix.sparseView();
}

template <class Entries>
SparseMatrix sparse(const ElasticPattern& pattern, const Entries& entries) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (int row = 0; row < pattern.size; ++row) {
    for (int i = pattern.row_start[static_cast<std::size_t>(row)];
         i < pattern.row_start[static_cast<std::size_t>(row) + 1]; ++i) {
      if (entries(i) == 0.0) continue;
      triplets.emplace_back(row, pattern.column[static_cast<std::size_t>(i)], entries(i));
    }
  }
  SparseMatrix matrix(pattern.size, pattern.size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

BodyConstants constants_of(const Invariants<double>& invariants) {
  BodyConstants constants;
  const ElasticPattern& pattern = invariants.pattern;
  constants.mass = invariants.mass;
  constants.first_moment = invariants.first_moment;
  constants.second_moment = invariants.second_moment;
  constants.shape = sparse(invariants.shape);
  constants.mixed = sparse(invariants.mixed);
  constants.mass_matrix = sparse(pattern, invariants.mass_matrix);
  constants.stiffness = sparse(pattern, invariants.stiffness);
  constants.damping = sparse(pattern, invariants.damping);
  for (std::size_t i = 0; i < moment_pairs.size(); ++i) {
    constants.moments[i] = SparseMatrix(pattern.size, pattern.size);
    const auto found = std::find(invariants.pairs.begin(), invariants.pairs.end(), moment_pairs[i]);
    if (found == invariants.pairs.end()) continue;
    constants.moments[i] =
        sparse(pattern, invariants.moments.col(found - invariants.pairs.begin()));
  }
  return constants;
}

/// Rows that act on nodal coordinates, and their derivatives.
struct NodalRows {
  MatrixXd value;
  std::vector<MatrixXd> derivatives;  ///< in the order of BodyModel::beam_x
};

struct NamedPlace {
  std::string name;
  BeamPlace place;
  double x;  ///< [m]
};

/// Where the scene and the responses hold on to a beam.
class PlaceFinder {
 public:
  PlaceFinder(const ProblemFile& problem, const BodyModel& body) : body_(body) {
    for (const DesignVariable& variable : problem.variables) start_.push_back(variable.start);
    for (const Body& other : problem.scene.bodies) {
      if (other.name == body.name) beam_ = &std::get<BeamBody>(other.shape);
    }
    add_scene(problem.scene);
    for (const ResponseSettings& response : problem.responses) add_response(response);
    for (int node = 0; node < body.beam.node_count(); ++node) {
      add(fmt::format("node {}", node), node == 0 ? BeamPlace{0, 0.0} : BeamPlace{node - 1, 1.0});
    }
    std::stable_sort(places_.begin(), places_.end(),
                     [](const NamedPlace& a, const NamedPlace& b) { return a.x < b.x; });
  }

  const std::vector<NamedPlace>& places() const { return places_; }

 private:
  void add_scene(const Scene& scene) {
    for (const Joint& joint : scene.joints) {
      add(joint.name, joint.bodies[0], joint.at);
      add(joint.name, joint.bodies[1], joint.type == JointType::distance ? joint.to : joint.at);
    }
    for (const Load& load : scene.loads) {
      if (const auto* force = std::get_if<PointForce>(&load.element)) {
        add(load.name, force->body, force->at);
      } else if (const auto* torque = std::get_if<PointTorque>(&load.element)) {
        add(load.name, torque->body, torque->at);
      } else if (const auto* spring = std::get_if<SpringDamper>(&load.element)) {
        for (std::size_t i = 0; i < 2; ++i) add(load.name, spring->bodies[i], spring->at[i]);
      }
    }
  }

  void add_response(const ResponseSettings& response) {
    const bool has_place =
        response.type == ResponseType::deflection || response.type == ResponseType::position ||
        response.type == ResponseType::velocity || response.type == ResponseType::acceleration;
    if (!has_place || response.bodies.front() != body_.name) return;
    add(response.name, find_place(body_.beam, response.at));
  }

  void add(const std::string& name, const std::string& body, const Point& at) {
    if (body == body_.name) add(name, find_place(body_.beam, share_along(*beam_, at, start_)));
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

/// A number of stress, of one point of one station.
struct StressPlace {
  std::string name;
  int station;
  int point;           ///< of the section, or −1: on its outline
  double angle = 0.0;  ///< on the outline
};

class BeamExport {
 public:
  BeamExport(const ProblemFile& problem, const BodyModel& body)
      : body_(body),
        places_(PlaceFinder(problem, body).places()),
        stations_(find_stations(body, {})) {
    find_stress_places();
  }

  BodyConstants constants() const {
    BodyConstants constants = constants_of(body_.invariants);
    for (const NamedPlace& place : places_) {
      BodyPlace added{place.name, {place.x, 0.0, 0.0}, {}, {}};
      const MatrixXd rows = value_of_rows(place_rows(place));
      added.displacement = sparse(rows.topRows(3));
      added.rotation = sparse(rows.bottomRows(3));
      constants.places.push_back(std::move(added));
    }
    constants.stretching = stretching();
    constants.stress = stress();
    return constants;
  }

  /// @param k  in the order of beam_x
  BodyConstants derivative(std::size_t k) const {
    BodyConstants change = constants_of(body_.invariants_x[k].data);
    const Beam<Dual>& beam = body_.beam_x[k].second;
    for (const NamedPlace& place : places_) {
      BodyPlace added{
          place.name, {derivative_of(position_of(beam, place.place)), 0.0, 0.0}, {}, {}};
      const MatrixXd rows = derivative_of_rows(place_rows(place), k);
      added.displacement = sparse(rows.topRows(3));
      added.rotation = sparse(rows.bottomRows(3));
      change.places.push_back(std::move(added));
    }
    change.stretching = stretching_derivative(k);
    change.stress = stress_derivative(k);
    return change;
  }

 private:
  // From nodal coordinates to those of the body.

  int nodal_index(int node, int i) const { return body_.coordinates->index(node, i); }

  MatrixXd value_of_rows(const NodalRows& rows) const {
    return body_.basis ? MatrixXd(rows.value * *body_.basis) : rows.value;
  }
  MatrixXd derivative_of_rows(const NodalRows& rows, std::size_t k) const {
    if (!body_.basis) return rows.derivatives[k];
    return rows.derivatives[k] * *body_.basis + rows.value * body_.basis_x[k].data;
  }

  /// Puts columns of the twelve coordinates of an element where they belong.
  MatrixXd scatter(int element, const MatrixXd& columns) const {
    MatrixXd nodal = MatrixXd::Zero(columns.rows(), body_.coordinates->size());
    for (int i = 0; i < 12; ++i) {
      const int index = nodal_index(element + i / 6, i % 6);
      if (index >= 0) nodal.col(index) += columns.col(i);
    }
    return nodal;
  }

  NodalRows place_rows(const NamedPlace& named) const {
    const BeamPlace& place = named.place;
    const auto e = static_cast<std::size_t>(place.element);
    NodalRows rows;
    rows.value = scatter(place.element, place_shape(place, body_.beam.elements[e].length));
    for (const auto& [variable, beam] : body_.beam_x) {
      rows.derivatives.push_back(
          scatter(place.element, derivative_matrix(place_shape(place, beam.elements[e].length))));
    }
    return rows;
  }

  // Geometric stiffening.

  std::vector<int> active_displacements(int element) const {
    std::vector<int> active;
    for (int i = 0; i < 12; ++i) {
      if (nodal_index(element + i / 6, i % 6) >= 0) active.push_back(i);
    }
    return active;
  }

  std::optional<Stretching> stretching() const {
    if (!body_.has_stiffening) return std::nullopt;
    Stretching result;
    const int nodal = body_.coordinates->size();
    result.damping = body_.beam.stiffness_damping;
    result.displacements = sparse(body_.basis ? *body_.basis : MatrixXd::Identity(nodal, nodal));
    for (int e = 0; e < static_cast<int>(body_.beam.elements.size()); ++e) {
      const BeamElement<double>& source = body_.beam.elements[static_cast<std::size_t>(e)];
      const std::vector<int> active = active_displacements(e);
      StretchedElement element;
      element.elongation.setZero(static_cast<Eigen::Index>(active.size()));
      for (std::size_t i = 0; i < active.size(); ++i) {
        element.displacements.push_back(nodal_index(e + active[i] / 6, active[i] % 6));
        if (active[i] % 6 != 0) continue;
        element.elongation(static_cast<Eigen::Index>(i)) = active[i] == 0 ? -1.0 : 1.0;
      }
      element.axial_stiffness = source.young * source.section.area / source.length;
      element.slopes = MatrixXd(slope_matrix(source.length))(active, active);
      result.elements.push_back(std::move(element));
    }
    return result;
  }

  std::optional<Stretching> stretching_derivative(std::size_t k) const {
    std::optional<Stretching> result = stretching();
    if (!result) return result;
    const Beam<Dual>& beam = body_.beam_x[k].second;
    result->damping = derivative_of(beam.stiffness_damping);
    const int nodal = body_.coordinates->size();
    result->displacements =
        body_.basis ? sparse(body_.basis_x[k].data) : SparseMatrix(nodal, nodal);
    for (std::size_t e = 0; e < beam.elements.size(); ++e) {
      const BeamElement<Dual>& source = beam.elements[e];
      StretchedElement& element = result->elements[e];
      element.axial_stiffness =
          derivative_of(Dual(source.young * source.section.area / source.length));
      const std::vector<int> active = active_displacements(static_cast<int>(e));
      element.slopes = MatrixXd(derivative_matrix(slope_matrix(source.length)))(active, active);
    }
    return result;
  }

  // Stress.

  const SectionProperties<double>& section_of(int station) const {
    const int element = stations_[static_cast<std::size_t>(station)].elements.front();
    return body_.beam.elements[static_cast<std::size_t>(element)].section;
  }

  void find_stress_places() {
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
  static StressPoint<Scalar> point_of(const SectionProperties<Scalar>& section,
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
  static Eigen::Matrix<Scalar, 2, 19> unit_stresses(const BeamElement<Scalar>& element,
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

  /// The matrices of the recovery in nodal coordinates.
  struct StressRows {
    MatrixXd of_nodal, of_accelerations, of_stretching;
  };

  int place_of_node(int node) const {
    const double x = body_.beam.node_position(node);
    const auto nearest = std::min_element(places_.begin(), places_.end(),
                                          [x](const NamedPlace& a, const NamedPlace& b) {
                                            return std::abs(a.x - x) < std::abs(b.x - x);
                                          });
    return static_cast<int>(nearest - places_.begin());
  }

  /// @param number  Scalar → double: value or derivative
  template <class Scalar, class Number>
  StressRows stress_rows(const Beam<Scalar>& beam, const Number& number) const {
    const auto rows = 6 * static_cast<Eigen::Index>(stress_places_.size());
    const auto elements = static_cast<Eigen::Index>(beam.elements.size());
    StressRows result{MatrixXd::Zero(rows, body_.coordinates->size()),
                      MatrixXd::Zero(rows, 3 * static_cast<Eigen::Index>(places_.size())),
                      MatrixXd::Zero(rows, elements)};
    for (std::size_t i = 0; i < stress_places_.size(); ++i) {
      const Station& station = stations_[static_cast<std::size_t>(stress_places_[i].station)];
      const auto& section =
          beam.elements[static_cast<std::size_t>(station.elements.front())].section;
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

  void add_element(Eigen::Index row, int e, const MatrixXd& columns, StressRows& rows) const {
    MatrixXd strain = columns.leftCols(12);
    strain.col(0) -= columns.col(12);
    strain.col(6) += columns.col(12);
    const MatrixXd nodal = scatter(e, strain);
    for (int r = 0; r < 2; ++r) {  // σ_xx and τ_xy of six
      const Eigen::Index at = row + (r == 0 ? 0 : 3);
      rows.of_nodal.row(at) += nodal.row(r);
      for (int end : {0, 1}) {
        rows.of_accelerations.row(at).segment(3 * place_of_node(e + end), 3) +=
            columns.row(r).segment(13 + 3 * end, 3);
      }
    }
  }

  StressRecovery recovery_of(const StressRows& rows, const MatrixXd& of_coordinates) const {
    StressRecovery recovery;
    for (const StressPlace& place : stress_places_) recovery.points.push_back(place.name);
    recovery.of_coordinates = sparse(of_coordinates);
    recovery.of_accelerations = sparse(rows.of_accelerations);
    recovery.of_stretching = body_.has_stiffening ? sparse(rows.of_stretching)
                                                  : SparseMatrix(rows.of_stretching.rows(), 0);
    return recovery;
  }

  StressRows stress_values() const {
    return stress_rows(body_.beam, [](double number) { return number; });
  }

  std::optional<StressRecovery> stress() const {
    const StressRows rows = stress_values();
    StressRecovery recovery = recovery_of(rows, value_of_rows({rows.of_nodal, {}}));
    recovery.strength = body_.beam.elements.front().strength;
    return recovery;
  }

  std::optional<StressRecovery> stress_derivative(std::size_t k) const {
    const Beam<Dual>& beam = body_.beam_x[k].second;
    const StressRows rows =
        stress_rows(beam, [](const Dual& number) { return derivative_of(number); });
    const MatrixXd of_coordinates = body_.basis
                                        ? MatrixXd(rows.of_nodal * *body_.basis +
                                                   stress_values().of_nodal * body_.basis_x[k].data)
                                        : rows.of_nodal;
    StressRecovery recovery = recovery_of(rows, of_coordinates);
    recovery.strength = derivative_of(beam.elements.front().strength);
    return recovery;
  }

  const BodyModel& body_;
  std::vector<NamedPlace> places_;
  std::vector<Station> stations_;
  std::vector<StressPlace> stress_places_;
};

std::vector<std::string> coordinate_names(const BodyModel& body) {
  constexpr std::array<const char*, 6> displacements = {"u", "v", "w", "θx", "θy", "θz"};
  std::vector<std::string> names(static_cast<std::size_t>(body.elastic_size()));
  if (body.basis) {
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = fmt::format("mode {}", i + 1);
    return names;
  }
  for (int node = 0; node < body.coordinates->node_count(); ++node) {
    for (int i = 0; i < 6; ++i) {
      const int index = body.coordinates->index(node, i);
      if (index < 0) continue;
      names[static_cast<std::size_t>(index)] =
          fmt::format("{} of node {}", displacements[static_cast<std::size_t>(i)], node);
    }
  }
  return names;
}

std::string condition_name(ReferenceCondition condition) {
  switch (condition) {
    case ReferenceCondition::tangent:
      return "tangent";
    case ReferenceCondition::tangent_end:
      return "tangent-end";
    case ReferenceCondition::chord:
      return "chord";
    default:
      return "mean-axis";
  }
}

/// An imported body goes on as it came, at the design of the model.
InvariantsFile pass_on(const ImportedBody& imported, const BodyModel& model) {
  InvariantsFile file = *imported.file;
  file.body = model.name;
  file.constants = *model.constants;
  return file;
}

}  // namespace

InvariantsFile export_body(const ProblemFile& problem, const Model& model, const std::string& name,
                           const std::vector<std::string>& units) {
  const BodyModel& body = model.body(name);
  const auto source = std::find_if(problem.scene.bodies.begin(), problem.scene.bodies.end(),
                                   [&](const Body& other) { return other.name == name; });
  if (!body.is_elastic) {
    throw InputError(fmt::format("the body \"{}\" is rigid: it has no elastic coordinates", name));
  }
  if (const auto* imported = std::get_if<ImportedBody>(&source->shape)) {
    return pass_on(*imported, body);
  }
  const BeamExport beam(problem, body);
  InvariantsFile file;
  file.body = name;
  file.description = fmt::format("of the problem {}", problem.name);
  file.reference_condition = condition_name(std::get<BeamBody>(source->shape).frame);
  file.coordinates = coordinate_names(body);
  file.constants = beam.constants();
  for (std::size_t k = 0; k < body.beam_x.size(); ++k) {
    const auto variable = static_cast<std::size_t>(body.beam_x[k].first);
    file.design.push_back({problem.variables[variable].name, problem.variables[variable].start,
                           units[variable], beam.derivative(k)});
  }
  return file;
}

}  // namespace pleuel
