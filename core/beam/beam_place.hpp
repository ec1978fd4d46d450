#pragma once

#include <cmath>

#include "core/base/int_size.hpp"
#include "core/beam/beam.hpp"
#include "core/beam/beam_shape.hpp"

namespace pleuel {

/// A place along the axis of a beam. Shares of the length do not depend on the design: all elements
/// scale with the beam.
struct BeamPlace {
  int element = 0;
  double xi = 0.0;  ///< in the element, 0 … 1

  bool is_node() const { return xi == 0.0 || xi == 1.0; }
  int node() const { return xi < 0.5 ? element : element + 1; }
};

/// @param at  share of the length, 0 … 1; what is a node up to round-off becomes one
inline BeamPlace find_place(const Beam<double>& beam, double at) {
  const int elements = int_size(beam.elements);
  const double x = at * beam.node_position(elements);
  for (int e = 0; e < elements; ++e) {
    const double start = beam.node_position(e);
    const double length = beam.elements[e].length;
    if (x > start + length && e + 1 < elements) continue;
    const double xi = (x - start) / length;
    if (std::abs(xi) < 1e-9) return {e, 0.0};
    if (std::abs(xi - 1.0) < 1e-9) return {e, 1.0};
    return {e, xi};
  }
  return {};
}

/// Local x of a place [m].
template <class Scalar>
Scalar position_of(const Beam<Scalar>& beam, const BeamPlace& place) {
  return beam.node_position(place.element) + place.xi * beam.elements[place.element].length;
}

/// u v w θx θy θz of a place, one row each, from the twelve coordinates of its element.
template <class Scalar>
Eigen::Matrix<Scalar, 6, 12> place_shape(const BeamPlace& place, const ElementForm<Scalar>& form) {
  Eigen::Matrix<Scalar, 6, 12> shape;
  shape.template topRows<3>() = axis_shape(place.xi, form);
  shape.row(3) = linear_row<Scalar>(3, place.xi);
  shape.row(4) = rotation_y_row(place.xi, form);
  shape.row(5) = rotation_z_row(place.xi, form);
  return shape;
}

}  // namespace pleuel
