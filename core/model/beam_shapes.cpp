#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/beam/beam_shape.hpp"
#include "core/beam/elastic_coordinates.hpp"
#include "core/effects/geometric_stiffening.hpp"
#include "core/model/elastic_builders.hpp"

namespace pleuel {

namespace {

class ShapeBuilder {
 public:
  explicit ShapeBuilder(BodyModel& model) : model_(model) {}

  void build(const SparseMatrix& basis, const std::vector<SparseMatrix>& basis_x) {
    const SparseMatrix selection = all_displacements();
    const auto number = [](double value) { return value; };
    const auto derivative = [](const Dual& value) { return derivative_of(value); };
    model_.places = {{}, positions(model_.beam, number), selection * basis};
    if (model_.has_stiffening) model_.stretching = stretching(model_.beam, number, basis);
    for (std::size_t k = 0; k < basis_x.size(); ++k) {
      const auto& [variable, beam] = model_.beam_x[k];
      model_.places_x.push_back(
          {variable, {{}, positions(beam, derivative), selection * basis_x[k]}});
      if (!model_.has_stiffening) continue;
      model_.stretching_x.push_back({variable, stretching(beam, derivative, basis_x[k])});
    }
  }

 private:
  /// From the nodal displacements that the beam has to six a node.
  SparseMatrix all_displacements() const {
    const ElasticCoordinates& nodal = model_.coordinates;
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < 6 * nodal.node_count(); ++row) {
      const int index = nodal.index(row / 6, row % 6);
      if (index >= 0) entries.emplace_back(row, index, 1.0);
    }
    SparseMatrix selection(6 * nodal.node_count(), nodal.size());
    selection.setFromTriplets(entries.begin(), entries.end());
    return selection;
  }

  template <class Scalar, class Number>
  static Eigen::Matrix3Xd positions(const Beam<Scalar>& beam, const Number& number) {
    Eigen::Matrix3Xd positions = Eigen::Matrix3Xd::Zero(3, beam.node_count());
    for (int node = 1; node < beam.node_count(); ++node) {
      positions(0, node) = number(beam.node_position(node));
    }
    return positions;
  }

  template <class Scalar, class Number>
  Stretching stretching(const Beam<Scalar>& beam, const Number& number,
                        const SparseMatrix& displacements) const {
    Stretching result{number(beam.stiffness_damping), displacements, {}};
    for (int e = 0; e < int_size(beam.elements); ++e) {
      const BeamElement<Scalar>& element = beam.elements[e];
      const std::vector<int> active = active_displacements(model_.coordinates, e);
      std::vector<int> indices;
      for (int i : active) indices.push_back(model_.coordinates.index(e + i / 6, i % 6));
      const auto slopes = slope_matrix(form_of(element));
      result.elements.push_back({std::move(indices), elongation_of(active),
                                 number(axial_stiffness(element)),
                                 slopes(active, active).unaryExpr(number)});
    }
    return result;
  }

  BodyModel& model_;
};

}  // namespace

void set_shapes(const SparseMatrix& basis, const std::vector<SparseMatrix>& basis_x,
                BodyModel& model) {
  ShapeBuilder(model).build(basis, basis_x);
}

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
