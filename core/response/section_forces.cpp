#include "core/response/section_forces.hpp"

#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/beam/beam_shape.hpp"

namespace pleuel {

namespace {

/// Rows in the order of SectionForcePart.
constexpr int axial = 0, moment_y = 1, moment_z = 2, torque = 3, shear_y = 4, shear_z = 5;
constexpr int row_count = 6;
static_assert(static_cast<int>(SectionForcePart::shear_z) == shear_z);

/// Moment over w ℓ² in a clamped element under the load w ξ. What of the load is even about the middle
/// does not shear the element as a whole. Of w (ξ − ½) the moment is w ℓ² (t³/6 + c t), t = ξ − ½, and
/// ends that do not move apart, ∫ (ℓ − x) M/EI dx = ΔM/(κGA), ask for c = −(1/40 + Φ/24)/(1 + Φ).
/// @param shear  Φ/(1 + Φ) of the plane
template <class Scalar>
Scalar clamped_change(const Scalar& xi, const Scalar& shear) {
  return xi * xi * xi / 6.0 - 3.0 * xi / 20.0 + 1.0 / 30.0 - shear * ((xi - 0.5) / 60.0);
}

/// The section forces at a place of an element, as rows.
template <class Scalar>
struct ElementForces {
  Eigen::Matrix<Scalar, row_count, 12> of_coordinates;
  /// Of those of both nodes against free fall, local axes.
  Eigen::Matrix<Scalar, row_count, 6> of_accelerations;

  ElementForces(const BeamElement<Scalar>& element, const Scalar& xi) {
    const ElementForm<Scalar> form = form_of(element);
    of_coordinates.setConstant(Scalar(0));
    of_accelerations.setConstant(Scalar(0));
    set_strain(element, form, xi);
    set_inertia(element, form, xi);
    set_shear(element, xi, 1, form.shear_y);
    set_shear(element, xi, 2, form.shear_z);
  }

 private:
  void set_strain(const BeamElement<Scalar>& element, const ElementForm<Scalar>& form,
                  const Scalar& xi) {
    const SectionProperties<Scalar>& section = element.section;
    const Scalar& length = element.length;
    of_coordinates(axial, 6) = element.young * section.area / length;
    of_coordinates(axial, 0) = -of_coordinates(axial, 6);
    of_coordinates(torque, 9) = element.shear * section.torsion / length;
    of_coordinates(torque, 3) = -of_coordinates(torque, 9);
    of_coordinates.row(moment_z) =
        element.young * section.inertia_z * deflection_y_row(xi, form, 2);
    of_coordinates.row(moment_y) =
        -(element.young * section.inertia_y) * deflection_z_row(xi, form, 2);
  }

  /// What the linear load w = w₁ + ξ Δ does in a clamped element: EI θ' and EA u' with M″ = w,
  /// N' = −w, and no displacement and rotation at the ends.
  void set_inertia(const BeamElement<Scalar>& element, const ElementForm<Scalar>& form,
                   const Scalar& xi) {
    const Scalar density = -element.density * element.section.area;
    const Scalar along = density * element.length, across = along * element.length;
    const Scalar along_start = 0.5 - xi, along_change = 1.0 / 6.0 - xi * xi / 2.0;
    const Scalar start = xi * xi / 2.0 - xi / 2.0 + 1.0 / 12.0;
    const Scalar change_y = clamped_change(xi, form.shear_y);
    const Scalar change_z = clamped_change(xi, form.shear_z);
    of_accelerations(axial, 0) = along * (along_start - along_change);
    of_accelerations(axial, 3) = along * along_change;
    of_accelerations(moment_z, 1) = across * (start - change_y);
    of_accelerations(moment_z, 4) = across * change_y;
    of_accelerations(moment_y, 2) = across * (change_z - start);
    of_accelerations(moment_y, 5) = across * -change_z;
  }

  /// The shear force along local y (1) or z (2): the derivatives of the rows of the moments.
  /// @param shear  Φ/(1 + Φ) of the plane
  void set_shear(const BeamElement<Scalar>& element, const Scalar& xi, int direction,
                 const Scalar& shear) {
    const SectionProperties<Scalar>& section = element.section;
    const Scalar& length = element.length;
    // v‴ of the cubic with the values and rotations at both nodes: (12, 6ℓ, −12, 6ℓ)/ℓ³ (1 − s).
    const bool is_y = direction == 1;
    const Scalar inertia = is_y ? section.inertia_z : section.inertia_y;
    const Scalar stiffness = element.young * inertia * (1.0 - shear);
    const Scalar third = -stiffness / (length * length * length);
    const Scalar turned = (is_y ? 6.0 : -6.0) * third * length;
    const int row = is_y ? shear_y : shear_z, turn = is_y ? 5 : 4;
    of_coordinates(row, direction) = 12.0 * third;
    of_coordinates(row, turn) = turned;
    of_coordinates(row, 6 + direction) = -12.0 * third;
    of_coordinates(row, 6 + turn) = turned;
    const Scalar across = -element.density * section.area * length;
    const Scalar start = xi - 0.5;
    const Scalar change = xi * xi / 2.0 - 3.0 / 20.0 - shear / 60.0;
    of_accelerations(row, direction) = across * (change - start);
    of_accelerations(row, 3 + direction) = across * -change;
  }
};

/// Writes dense blocks of neighbouring columns.
class RowWriter {
 public:
  RowWriter(Eigen::Index rows, Eigen::Index columns) : rows_(rows, columns) {}

  template <class Block>
  void add(Eigen::Index row, Eigen::Index column, const Block& block) {
    for (Eigen::Index i = 0; i < block.rows(); ++i) {
      for (Eigen::Index j = 0; j < block.cols(); ++j) {
        if (block(i, j) != 0.0) entries_.emplace_back(row + i, column + j, block(i, j));
      }
    }
  }
  SparseMatrix finish() {
    rows_.setFromTriplets(entries_.begin(), entries_.end());
    return std::move(rows_);
  }

 private:
  SparseMatrix rows_;
  std::vector<Eigen::Triplet<double>> entries_;
};

/// The strain's part of nodal displacements, and the load's of nodal accelerations.
struct NodalRows {
  SparseMatrix of_displacements, of_accelerations;
};

/// @param number  Scalar → double: value or derivative
/// @param place   station, number of one of its elements → where it is in it, 0 … 1
template <class Scalar, class Number, class Place>
NodalRows nodal_rows(const Beam<Scalar>& beam, const std::vector<Station>& stations,
                     std::span<const SectionForcePart> parts, const Number& number,
                     const Place& place) {
  const auto rows = std::ssize(parts) * std::ssize(stations);
  RowWriter displacements(rows, 6 * beam.node_count()), accelerations(rows, 3 * beam.node_count());
  Eigen::Index first = 0;
  for (const Station& station : stations) {
    const double share = 1.0 / static_cast<double>(station.elements.size());
    const auto scaled = [&](const Scalar& entry) { return share * number(entry); };
    for (std::size_t i = 0; i < station.elements.size(); ++i) {
      const int e = station.elements[i];
      const ElementForces<Scalar> forces(beam.elements[e], place(station, i));
      Eigen::Index row = first;
      for (const SectionForcePart part : parts) {
        const int from = static_cast<int>(part);
        displacements.add(row, 6 * e, forces.of_coordinates.row(from).unaryExpr(scaled).eval());
        accelerations.add(row, 3 * e, forces.of_accelerations.row(from).unaryExpr(scaled).eval());
        ++row;
      }
    }
    first += std::ssize(parts);
  }
  return {displacements.finish(), accelerations.finish()};
}

NodalRows value_rows(const BodyModel& body, const std::vector<Station>& stations,
                     std::span<const SectionForcePart> parts) {
  return nodal_rows(
      body.beam, stations, parts, [](double number) { return number; },
      [](const Station& station, std::size_t i) -> double {
        return station.place - station.elements[i];
      });
}

/// What the stretching of bent members adds to axial forces.
SparseMatrix stretching_rows(const BodyModel& body, const std::vector<Station>& stations,
                             std::span<const SectionForcePart> parts) {
  RowWriter rows(std::ssize(parts) * std::ssize(stations), body.stretching.elements.size());
  Eigen::Index row = 0;
  for (const Station& station : stations) {
    const double share = 1.0 / static_cast<double>(station.elements.size());
    for (const SectionForcePart part : parts) {
      for (const int e : station.elements) {
        if (part != SectionForcePart::axial || !body.has_stiffening) continue;
        rows.add(row, e, Eigen::Matrix<double, 1, 1>(share));
      }
      ++row;
    }
  }
  return rows.finish();
}

}  // namespace

Recovery section_recovery(const BodyModel& body, const std::vector<Station>& stations,
                          std::span<const SectionForcePart> parts) {
  NodalRows rows = value_rows(body, stations, parts);
  return {rows.of_displacements * body.places.shape, std::move(rows.of_accelerations),
          stretching_rows(body, stations, parts)};
}

Recovery section_recovery_derivative(const BodyModel& body, const std::vector<Station>& stations,
                                     std::span<const SectionForcePart> parts, std::size_t k) {
  NodalRows change = nodal_rows(
      body.beam_x[k].second, stations, parts,
      [](const Dual& number) { return derivative_of(number); },
      [k](const Station& station, std::size_t i) { return station.xi_along(i, k); });
  SparseMatrix of_coordinates = change.of_displacements * body.places.shape;
  const SparseMatrix& shape_x = body.places_x[k].data.shape;
  if (shape_x.nonZeros() > 0) {
    const NodalRows rows = value_rows(body, stations, parts);
    of_coordinates += SparseMatrix(rows.of_displacements * shape_x);
  }
  SparseMatrix of_stretching(of_coordinates.rows(), body.stretching.elements.size());
  return {std::move(of_coordinates), std::move(change.of_accelerations), std::move(of_stretching)};
}

}  // namespace pleuel
