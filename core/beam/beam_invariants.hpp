#pragma once

#include <type_traits>

#include "core/base/dual.hpp"
#include "core/base/int_size.hpp"
#include "core/beam/beam.hpp"
#include "core/beam/beam_shape.hpp"
#include "core/beam/elastic_coordinates.hpp"
#include "core/beam/invariants.hpp"

namespace pleuel {

/// Whether the inertia of the sections about their own axes (I_y, I_z) enters the inertia
/// integrals. Their polar inertia is always there, in torsion and where the whole beam spins about
/// its axis: without it that would cost nothing.
enum class RotaryInertia { included, neglected };

/// Element stiffness (12 × 12): ∫ EA u'u' + EI_z v''v'' + EI_y w''w'' + GJ θx'θx' dx, and where shear
/// bends it + κGA (γyγy + γzγz); curvatures θ' are v'', as γ is constant.
template <class Scalar>
Eigen::Matrix<Scalar, 12, 12> element_stiffness(const BeamElement<Scalar>& element) {
  using Matrix = Eigen::Matrix<Scalar, 12, 12>;
  const SectionProperties<Scalar>& section = element.section;
  Matrix stiffness = Matrix::Constant(Scalar(0));
  const Scalar axial = element.young * section.area / element.length;
  const Scalar torsional = element.shear * section.torsion / element.length;
  for (int i : {0, 3}) {
    const Scalar& k = i == 0 ? axial : torsional;
    stiffness(i, i) += k;
    stiffness(i + 6, i + 6) += k;
    stiffness(i, i + 6) -= k;
    stiffness(i + 6, i) -= k;
  }
  const Scalar bending_z = element.young * section.inertia_z;
  const Scalar bending_y = element.young * section.inertia_y;
  const ElementForm<Scalar> form = form_of(element);
  for (const GaussPoint& point : gauss_points) {
    const auto v = deflection_y_row(point.xi, form, 2);
    const auto w = deflection_z_row(point.xi, form, 2);
    const Scalar weight = point.weight * element.length;
    stiffness +=
        (weight * bending_z) * (v.transpose() * v) + (weight * bending_y) * (w.transpose() * w);
  }
  const auto add_shear = [&](const ElementRow<Scalar>& angle, const Scalar& compliance) {
    if (value_of(compliance) == 0.0) return;
    stiffness += (element.length / compliance) * (angle.transpose() * angle);
  };
  add_shear(shear_y_row(form), element.shear_compliance_y);
  add_shear(shear_z_row(form), element.shear_compliance_z);
  return stiffness;
}

namespace beam_detail {

/// Adds ∫ρ over one line of points p₀ = base, displacement = shape, with mass `mass`.
template <class Scalar>
struct InvariantSum {
  Invariants<Scalar>& sum;
  const std::array<int, 12>& indices;

  void add(const Scalar& mass, const Eigen::Matrix<Scalar, 3, 1>& base,
           const ElementShape<Scalar>& shape) {
    sum.second_moment += mass * base * base.transpose();
    for (int j = 0; j < 12; ++j) {
      const int column = indices[j];
      if (column < 0) continue;
      for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < 3; ++l) sum.mixed(3 * k + l, column) += mass * base(k) * shape(l, j);
      }
      add_moments(mass, shape, j, column);
    }
  }

  void add_moments(const Scalar& mass, const ElementShape<Scalar>& shape, int j, int column) {
    for (int i = 0; i < 12; ++i) {
      const int row = indices[i];
      if (row < 0) continue;
      const int position = sum.pattern.find(row, column);
      for (std::size_t p = 0; p < sum.pairs.size(); ++p) {
        const auto [k, l] = sum.pairs[p];
        sum.moments(position, static_cast<int>(p)) += mass * shape(k, i) * shape(l, j);
      }
    }
  }
};

template <class Scalar>
void add_element_inertia(const BeamElement<Scalar>& element, const Scalar& start,
                         RotaryInertia rotary, const std::array<int, 12>& indices,
                         Invariants<Scalar>& sum) {
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
  const Scalar zero(0), one(1);
  InvariantSum<Scalar> integral{sum, indices};
  const ElementForm<Scalar> form = form_of(element);
  for (const GaussPoint& point : gauss_points) {
    const Scalar per_area = element.density * point.weight * element.length;
    const Scalar mass = per_area * element.section.area;
    const Scalar x = start + point.xi * element.length;
    const ElementShape<Scalar> shape = axis_shape(point.xi, form);
    sum.mass += mass;
    sum.first_moment(0) += mass * x;
    for (int j = 0; j < 12; ++j) {
      const int column = indices[j];
      if (column >= 0) sum.shape.col(column) += mass * shape.col(j);
    }
    integral.add(mass, Vector3(x, zero, zero), shape);
    // Off-axis points: ∫y dA = ∫z dA = ∫yz dA = 0 leave the second moments of the section only.
    ElementShape<Scalar> y_shape = y_offset_shape(point.xi, form);
    ElementShape<Scalar> z_shape = z_offset_shape(point.xi, form);
    Scalar inertia_y = element.section.inertia_y, inertia_z = element.section.inertia_z;
    if (rotary == RotaryInertia::neglected) {
      // Points off the axis stay beside it when it tilts; what is taken from x² leaves a tensor of
      // inertia with the polar inertia about x, and none of the sections about y and z.
      y_shape.row(0).setConstant(zero);
      z_shape.row(0).setConstant(zero);
      inertia_y = inertia_z = (inertia_y + inertia_z) / 2.0;
      sum.second_moment(0, 0) -= per_area * inertia_y;
    }
    integral.add(per_area * inertia_z, Vector3(zero, one, zero), y_shape);
    integral.add(per_area * inertia_y, Vector3(zero, zero, one), z_shape);
  }
}

/// The pairs of displacement directions that the coordinates of a beam can couple.
inline std::vector<std::pair<int, int>> coupled_pairs(const ElasticCoordinates& coordinates) {
  std::array<bool, 3> moves{};
  for (int node = 0; node < coordinates.node_count(); ++node) {
    const auto has = [&](int displacement) { return coordinates.index(node, displacement) >= 0; };
    moves[0] = moves[0] || has(0) || has(4) || has(5);
    moves[1] = moves[1] || has(1) || has(3) || has(5);
    moves[2] = moves[2] || has(2) || has(3) || has(4);
  }
  std::vector<std::pair<int, int>> pairs;
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) {
      if (moves[k] && moves[l]) {
        pairs.emplace_back(k, l);
      }
    }
  }
  return pairs;
}

}  // namespace beam_detail

/// Pattern of a beam's matrices: the active coordinates of an element are coupled.
inline ElasticPattern beam_pattern(const ElasticCoordinates& coordinates) {
  std::vector<std::vector<int>> groups;
  for (int i = 0; i + 1 < coordinates.node_count(); ++i) {
    const auto indices = coordinates.element_indices(i);
    groups.emplace_back(indices.begin(), indices.end());
  }
  return pattern_of_groups(coordinates.size(), groups);
}

namespace beam_detail {

template <class Scalar>
Invariants<Scalar> no_invariants(const ElasticCoordinates& coordinates) {
  Invariants<Scalar> sum;
  const Scalar zero(0);
  sum.pattern = beam_pattern(coordinates);
  sum.pairs = coupled_pairs(coordinates);
  const int n = sum.size(), nonzeros = sum.pattern.nonzeros();
  sum.shape.setConstant(3, n, zero);
  sum.mixed.setConstant(9, n, zero);
  sum.moments.setConstant(nonzeros, int_size(sum.pairs), zero);
  sum.stiffness.setConstant(nonzeros, zero);
  sum.mass_matrix.setConstant(nonzeros, zero);
  return sum;
}

template <class Scalar>
void add_element_stiffness(const BeamElement<Scalar>& element, const std::array<int, 12>& indices,
                           Invariants<Scalar>& sum) {
  const auto stiffness = element_stiffness(element);
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) {
      const int row = indices[i], col = indices[j];
      if (row >= 0 && col >= 0) sum.stiffness(sum.pattern.find(row, col)) += stiffness(i, j);
    }
  }
}

/// Whether the invariants of an element depend on the seeded variable.
inline bool is_varied(const BeamElement<Dual>& element) {
  const SectionProperties<Dual>& section = element.section;
  for (const Dual& number : {element.length, element.young, element.shear, element.density,
                             section.area, section.inertia_y, section.inertia_z, section.torsion,
                             element.shear_compliance_y, element.shear_compliance_z}) {
    if (derivative_of(number) != 0.0) return true;
  }
  return false;
}

/// @param counts  which elements are summed, by (element, its start along the beam)
template <class Scalar, class Predicate>
Invariants<Scalar> sum_elements(const Beam<Scalar>& beam, const ElasticCoordinates& coordinates,
                                RotaryInertia rotary, const Predicate& counts) {
  Invariants<Scalar> sum = no_invariants<Scalar>(coordinates);
  Scalar start(0);
  for (int e = 0; e < int_size(beam.elements); ++e) {
    const BeamElement<Scalar>& element = beam.elements[e];
    if (counts(element, start)) {
      const auto indices = coordinates.element_indices(e);
      add_element_inertia(element, start, rotary, indices, sum);
      add_element_stiffness(element, indices, sum);
    }
    start += element.length;
  }
  for (std::size_t p = 0; p < sum.pairs.size(); ++p) {
    if (sum.pairs[p].first == sum.pairs[p].second) {
      sum.mass_matrix += sum.moments.col(static_cast<int>(p));
    }
  }
  sum.damping = beam.mass_damping * sum.mass_matrix + beam.stiffness_damping * sum.stiffness;
  return sum;
}

}  // namespace beam_detail

/// Invariants of a beam in its local axes (origin at the first node), by one set of shape functions
/// and exact quadrature.
template <class Scalar>
Invariants<Scalar> beam_invariants(const Beam<Scalar>& beam, const ElasticCoordinates& coordinates,
                                   RotaryInertia rotary = RotaryInertia::included) {
  return beam_detail::sum_elements(beam, coordinates, rotary,
                                   [](const auto&, const auto&) { return true; });
}

/// Invariants whose derivative alone is wanted: those of seeded dual numbers leave out elements that
/// do not depend on the seeded variable, which are most of a beam with many segments.
template <class Scalar>
Invariants<Scalar> varied_invariants(const Beam<Scalar>& beam,
                                     const ElasticCoordinates& coordinates, RotaryInertia rotary) {
  if constexpr (std::is_same_v<Scalar, Dual>) {
    const bool is_damping_varied =
        derivative_of(beam.mass_damping) != 0.0 || derivative_of(beam.stiffness_damping) != 0.0;
    return beam_detail::sum_elements(beam, coordinates, rotary,
                                     [&](const BeamElement<Dual>& element, const Dual& start) {
                                       return is_damping_varied || derivative_of(start) != 0.0 ||
                                              beam_detail::is_varied(element);
                                     });
  } else {
    return beam_invariants(beam, coordinates, rotary);
  }
}

}  // namespace pleuel
