#include "core/model/stiffening_builder.hpp"

#include "core/effects/geometric_stiffening.hpp"
#include "core/system/projected_term.hpp"

namespace pleuel {

namespace {

/// The way from the body's coordinates to the displacements that stretch it.
CoordinateMap map_of(const BodyModel& body) {
  CoordinateMap map;
  for (int i = 0; i < body.elastic_size(); ++i) {
    map.coordinates.push_back(body.elastic_offset() + i);
  }
  map.rows = Eigen::MatrixXd(body.stretching.displacements);
  for (const auto& [variable, change] : body.stretching_x) {
    Eigen::MatrixXd rows(change.displacements);
    if (!rows.isZero(0.0)) map.derivatives.push_back({variable, std::move(rows)});
  }
  return map;
}

/// Where the displacements that stretch a body are coordinates of it themselves: their indices in
/// q.
std::optional<std::vector<int>> find_coordinates(const BodyModel& body) {
  const SparseMatrix& rows = body.stretching.displacements;
  std::vector<int> coordinates;
  for (int row = 0; row < rows.outerSize(); ++row) {
    int entries = 0;
    for (SparseMatrix::InnerIterator entry(rows, row); entry; ++entry) {
      if (entry.value() != 1.0 || ++entries > 1) return std::nullopt;
      coordinates.push_back(body.elastic_offset() + static_cast<int>(entry.col()));
    }
    if (entries == 0) return std::nullopt;
  }
  for (const auto& [variable, change] : body.stretching_x) {
    const SparseMatrix& of = change.displacements;
    if (of.nonZeros() > 0 && !of.coeffs().isZero(0.0)) return std::nullopt;
  }
  return coordinates;
}

std::vector<StiffeningDerivative> differentiate_stiffening(const Stretching& change) {
  std::vector<StiffeningDerivative> derivatives;
  for (std::size_t e = 0; e < change.elements.size(); ++e) {
    const StretchedElement& element = change.elements[e];
    StiffeningDerivative derivative{static_cast<int>(e), element.axial_stiffness, change.damping,
                                    element.slopes};
    const bool is_zero = derivative.axial_stiffness == 0.0 && derivative.damping == 0.0 &&
                         derivative.slopes.isZero(0.0);
    if (!is_zero) derivatives.push_back(std::move(derivative));
  }
  return derivatives;
}

}  // namespace

std::unique_ptr<Term> make_stiffening(const BodyModel& body, int coordinates) {
  const Stretching& stretching = body.stretching;
  const std::optional<std::vector<int>> direct = find_coordinates(body);
  std::vector<StiffeningElement> elements;
  for (const StretchedElement& element : stretching.elements) {
    elements.push_back(
        {element.displacements, element.elongation, element.axial_stiffness, element.slopes});
    if (!direct) continue;
    for (int& index : elements.back().coordinates)
      index = (*direct)[static_cast<std::size_t>(index)];
  }
  std::vector<DesignDerivative<std::vector<StiffeningDerivative>>> derivatives;
  for (const auto& [variable, change] : body.stretching_x) {
    auto changes = differentiate_stiffening(change);
    if (!changes.empty()) derivatives.push_back({variable, std::move(changes)});
  }
  auto term = std::make_unique<GeometricStiffening>(body.name, std::move(elements),
                                                    stretching.damping, derivatives);
  if (direct) return term;
  return std::make_unique<ProjectedTerm>(std::move(term), map_of(body), coordinates);
}

}  // namespace pleuel
