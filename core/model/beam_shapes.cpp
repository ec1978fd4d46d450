#include "core/model/beam_shapes.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/beam/beam_shape.hpp"
#include "core/beam/element_stretching.hpp"

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

}  // namespace pleuel
