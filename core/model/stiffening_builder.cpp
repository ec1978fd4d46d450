#include "core/model/stiffening_builder.hpp"

#include "core/effects/geometric_stiffening.hpp"
#include "core/model/imported_builder.hpp"
#include "core/system/projected_term.hpp"

namespace pleuel {

namespace {

struct LocalElement {
  std::vector<int> local;  ///< active element coordinates, 0 … 11
  StiffeningElement element;
};

LocalElement make_stiffening_element(const BodyModel& model, int e) {
  LocalElement result;
  const BeamElement<double>& source = model.beam.elements[static_cast<std::size_t>(e)];
  const Eigen::Matrix<double, 12, 12> slopes = slope_matrix(source.length);
  for (int i = 0; i < 12; ++i) {
    const int index = model.coordinate(e + i / 6, i % 6);
    if (index < 0) continue;
    result.local.push_back(i);
    result.element.coordinates.push_back(index);
  }
  const auto size = static_cast<Eigen::Index>(result.local.size());
  result.element.elongation.setZero(size);
  result.element.slopes.resize(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const int local = result.local[static_cast<std::size_t>(i)];
    if (local % 6 == 0) result.element.elongation(i) = local == 0 ? -1.0 : 1.0;
    for (Eigen::Index j = 0; j < size; ++j) {
      result.element.slopes(i, j) = slopes(local, result.local[static_cast<std::size_t>(j)]);
    }
  }
  result.element.axial_stiffness = source.young * source.section.area / source.length;
  return result;
}

StiffeningDerivative differentiate_stiffening(const LocalElement& local, int e,
                                              const Beam<Dual>& beam) {
  const BeamElement<Dual>& element = beam.elements[static_cast<std::size_t>(e)];
  StiffeningDerivative derivative;
  derivative.element = e;
  const Dual stiffness = element.young * element.section.area / element.length;
  derivative.axial_stiffness = derivative_of(stiffness);
  derivative.damping = derivative_of(beam.stiffness_damping);
  const Eigen::MatrixXd slopes = derivative_matrix(slope_matrix(element.length));
  const auto size = static_cast<Eigen::Index>(local.local.size());
  derivative.slopes.resize(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      derivative.slopes(i, j) = slopes(local.local[static_cast<std::size_t>(i)],
                                       local.local[static_cast<std::size_t>(j)]);
    }
  }
  return derivative;
}

std::unique_ptr<Term> make_nodal_stiffening(const BodyModel& model) {
  std::vector<LocalElement> locals;
  std::vector<StiffeningElement> elements;
  for (int e = 0; e < static_cast<int>(model.beam.elements.size()); ++e) {
    locals.push_back(make_stiffening_element(model, e));
    elements.push_back(locals.back().element);
  }
  std::vector<DesignDerivative<std::vector<StiffeningDerivative>>> derivatives;
  for (const auto& [variable, beam] : model.beam_x) {
    std::vector<StiffeningDerivative> changes;
    for (std::size_t e = 0; e < locals.size(); ++e) {
      StiffeningDerivative change = differentiate_stiffening(locals[e], static_cast<int>(e), beam);
      const bool is_zero =
          change.axial_stiffness == 0.0 && change.damping == 0.0 && change.slopes.isZero(0.0);
      if (!is_zero) changes.push_back(std::move(change));
    }
    if (!changes.empty()) derivatives.push_back({variable, std::move(changes)});
  }
  return std::make_unique<GeometricStiffening>(
      model.name, std::move(elements), model.beam.stiffness_damping, std::move(derivatives));
}

}  // namespace

std::unique_ptr<Term> make_stiffening(const BodyModel& body, int coordinates) {
  if (body.is_imported()) return make_imported_stiffening(body, coordinates);
  if (!body.basis) return make_nodal_stiffening(body);
  return std::make_unique<ProjectedTerm>(make_nodal_stiffening(*body.nodal), body.map, coordinates);
}

}  // namespace pleuel
