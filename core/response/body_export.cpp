#include "core/response/body_export.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/beam/element_stretching.hpp"
#include "core/response/stress_export.hpp"

namespace pleuel {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

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

class BeamExport {
 public:
  BeamExport(const ProblemFile& problem, const BodyModel& body)
      : body_(body), nodal_(body), places_(named_places(problem, body)), stress_(body, places_) {}

  BodyConstants constants() const {
    BodyConstants constants = constants_of(body_.invariants);
    for (const NamedPlace& place : places_) {
      const double length = element_of(body_.beam, place).length;
      const MatrixXd shape = nodal_.reduce(place_rows(place, place_shape(place.place, length)));
      constants.places.push_back(body_place(place.name, place.x, shape));
    }
    if (body_.has_stiffening) constants.stretching = stretching();
    constants.stress = stress_.value();
    return constants;
  }

  /// @param k  in the order of beam_x
  BodyConstants derivative(std::size_t k) const {
    BodyConstants change = constants_of(body_.invariants_x[k].data);
    const Beam<Dual>& beam = body_.beam_x[k].second;
    for (const NamedPlace& place : places_) {
      const auto shape = place_shape(place.place, element_of(beam, place).length);
      change.places.push_back(
          body_place(place.name, derivative_of(position_of(beam, place.place)),
                     nodal_.reduce_derivative(place_rows(place, value_matrix(shape)),
                                              place_rows(place, derivative_matrix(shape)), k)));
    }
    if (body_.has_stiffening) change.stretching = stretching_derivative(k);
    change.stress = stress_.derivative(k);
    return change;
  }

 private:
  template <class Scalar>
  static const BeamElement<Scalar>& element_of(const Beam<Scalar>& beam, const NamedPlace& place) {
    return beam.elements[static_cast<std::size_t>(place.place.element)];
  }

  MatrixXd place_rows(const NamedPlace& place, const MatrixXd& shape) const {
    return nodal_.scatter(place.place.element, shape);
  }

  static BodyPlace body_place(const std::string& name, double x, const MatrixXd& rows) {
    BodyPlace place{name, {x, 0.0, 0.0}, {}, {}};
    place.displacement = rows.topRows(3).sparseView();
    place.rotation = rows.bottomRows(3).sparseView();
    return place;
  }

  Stretching stretching() const {
    Stretching result;
    const int nodal = nodal_.nodal_size();
    result.damping = body_.beam.stiffness_damping;
    result.displacements = nodal_.reduce(MatrixXd::Identity(nodal, nodal)).sparseView();
    for (int e = 0; e < static_cast<int>(body_.beam.elements.size()); ++e) {
      const BeamElement<double>& source = body_.beam.elements[static_cast<std::size_t>(e)];
      const std::vector<int> active = active_displacements(*body_.coordinates, e);
      StretchedElement element;
      for (int i : active) {
        element.displacements.push_back(body_.coordinates->index(e + i / 6, i % 6));
      }
      element.elongation = elongation_of(active);
      element.axial_stiffness = axial_stiffness(source);
      element.slopes = slope_matrix(source.length)(active, active);
      result.elements.push_back(std::move(element));
    }
    return result;
  }

  Stretching stretching_derivative(std::size_t k) const {
    Stretching result = stretching();
    const Beam<Dual>& beam = body_.beam_x[k].second;
    result.damping = derivative_of(beam.stiffness_damping);
    const int nodal = nodal_.nodal_size();
    result.displacements =
        nodal_.reduce_derivative(MatrixXd::Identity(nodal, nodal), MatrixXd::Zero(nodal, nodal), k)
            .sparseView();
    for (std::size_t e = 0; e < beam.elements.size(); ++e) {
      const BeamElement<Dual>& source = beam.elements[e];
      StretchedElement& element = result.elements[e];
      element.axial_stiffness = derivative_of(axial_stiffness(source));
      const std::vector<int> active = active_displacements(*body_.coordinates, static_cast<int>(e));
      element.slopes = derivative_matrix(slope_matrix(source.length))(active, active);
    }
    return result;
  }

  const BodyModel& body_;
  NodalMap nodal_;
  std::vector<NamedPlace> places_;
  StressExport stress_;
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
  file.reference_condition = word_of(reference_conditions, std::get<BeamBody>(source->shape).frame);
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
