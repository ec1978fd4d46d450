#include "core/response/body_export.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/model/body_point.hpp"
#include "core/model/imported_constants.hpp"
#include "core/response/stress_export.hpp"

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
    const auto found = std::find(invariants.pairs.begin(), invariants.pairs.end(), moment_pairs[i]);
    if (found == invariants.pairs.end()) continue;
    constants.moments[i] =
        sparse(pattern, invariants.moments.col(found - invariants.pairs.begin()));
  }
  return constants;
}

BodyPlace body_place(const std::string& name, const PointShape& point) {
  return {name, point.position, point.shape.topRows(3), point.shape.bottomRows(3)};
}

class BeamExport {
 public:
  BeamExport(const ProblemFile& problem, const BodyModel& body)
      : body_(body), places_(named_places(problem, body)), stress_(body, places_) {
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
