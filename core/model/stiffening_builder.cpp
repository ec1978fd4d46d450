#include "core/model/stiffening_builder.hpp"

#include "core/effects/geometric_stiffening.hpp"

namespace pleuel {

namespace {

std::vector<StiffeningDerivative> differentiate_stiffening(
    const std::vector<StretchedElement>& changes, double damping) {
  std::vector<StiffeningDerivative> derivatives;
  for (std::size_t e = 0; e < changes.size(); ++e) {
    const StretchedElement& change = changes[e];
    StiffeningDerivative derivative{static_cast<int>(e), change.axial_stiffness, damping,
                                    change.elongation, change.slopes};
    const bool is_zero = derivative.axial_stiffness == 0.0 && derivative.damping == 0.0 &&
                         derivative.elongation.isZero(0.0) && derivative.slopes.isZero(0.0);
    if (!is_zero) derivatives.push_back(std::move(derivative));
  }
  return derivatives;
}

}  // namespace

std::unique_ptr<Term> make_stiffening(const BodyModel& body) {
  const StretchedMembers& members = *body.stretched;
  std::vector<StiffeningElement> elements;
  for (const StretchedElement& member : members.values) {
    elements.push_back(
        {member.displacements, member.elongation, member.axial_stiffness, member.slopes});
    for (int& index : elements.back().coordinates) index += body.elastic_offset();
  }
  std::vector<DesignDerivative<std::vector<StiffeningDerivative>>> derivatives;
  for (std::size_t k = 0; k < members.derivatives.size(); ++k) {
    const auto& [variable, changes] = members.derivatives[k];
    auto found = differentiate_stiffening(changes, body.stretching_x[k].data.damping);
    if (!found.empty()) derivatives.push_back({variable, std::move(found)});
  }
  return std::make_unique<GeometricStiffening>(body.name, std::move(elements),
                                               body.stretching.damping, derivatives);
}

}  // namespace pleuel
