#include "core/model/stiffening_builder.hpp"

#include "core/beam/element_stretching.hpp"
#include "core/effects/geometric_stiffening.hpp"
#include "core/model/imported_builder.hpp"
#include "core/system/projected_term.hpp"

namespace pleuel {

namespace {

using Active = std::vector<int>;

StiffeningElement make_stiffening_element(const BodyModel& model, int e, const Active& active) {
  const BeamElement<double>& source = model.beam.elements[static_cast<std::size_t>(e)];
  StiffeningElement element;
  for (int i : active) element.coordinates.push_back(model.coordinate(e + i / 6, i % 6));
  element.elongation = elongation_of(active);
  element.axial_stiffness = axial_stiffness(source);
  element.slopes = slope_matrix(source.length)(active, active);
  return element;
}

StiffeningDerivative differentiate_stiffening(const Beam<Dual>& beam, int e, const Active& active) {
  const BeamElement<Dual>& element = beam.elements[static_cast<std::size_t>(e)];
  StiffeningDerivative derivative;
  derivative.element = e;
  derivative.axial_stiffness = derivative_of(axial_stiffness(element));
  derivative.damping = derivative_of(beam.stiffness_damping);
  derivative.slopes = derivative_matrix(slope_matrix(element.length))(active, active);
  return derivative;
}

std::unique_ptr<Term> make_nodal_stiffening(const BodyModel& model) {
  std::vector<Active> active;
  std::vector<StiffeningElement> elements;
  for (int e = 0; e < static_cast<int>(model.beam.elements.size()); ++e) {
    active.push_back(active_displacements(*model.coordinates, e));
    elements.push_back(make_stiffening_element(model, e, active.back()));
  }
  std::vector<DesignDerivative<std::vector<StiffeningDerivative>>> derivatives;
  for (const auto& [variable, beam] : model.beam_x) {
    std::vector<StiffeningDerivative> changes;
    for (std::size_t e = 0; e < active.size(); ++e) {
      StiffeningDerivative change = differentiate_stiffening(beam, static_cast<int>(e), active[e]);
      const bool is_zero =
          change.axial_stiffness == 0.0 && change.damping == 0.0 && change.slopes.isZero(0.0);
      if (!is_zero) changes.push_back(std::move(change));
    }
    if (!changes.empty()) derivatives.push_back({variable, std::move(changes)});
  }
  return std::make_unique<GeometricStiffening>(model.name, std::move(elements),
                                               model.beam.stiffness_damping, derivatives);
}

}  // namespace

std::unique_ptr<Term> make_stiffening(const BodyModel& body, int coordinates) {
  if (body.is_imported()) return make_imported_stiffening(body, coordinates);
  if (!body.basis) return make_nodal_stiffening(body);
  return std::make_unique<ProjectedTerm>(make_nodal_stiffening(*body.nodal), body.map, coordinates);
}

}  // namespace pleuel
