#pragma once

#include <cmath>
#include <type_traits>
#include <vector>

#include "core/base/element_place.hpp"
#include "core/base/int_size.hpp"
#include "core/beam/beam.hpp"
#include "core/beam/beam_shape.hpp"

namespace pleuel {

/// A place along the axis of a beam. ξ depends on the design only where nodes of the mesh follow places
/// that design variables move (core/scene/beam_mesh.hpp).
struct BeamPlace : ElementPlace {
  std::vector<double> xi_x = {};  ///< derivatives of ξ, in the order of those of the body; or none
};

/// @param at  share of the length, 0 … 1; what is a node up to round-off becomes one
inline ElementPlace find_place(const Beam<double>& beam, double at) {
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
Scalar position_of(const Beam<Scalar>& beam, const ElementPlace& place) {
  return beam.node_position(place.element) + place.xi * beam.elements[place.element].length;
}

/// u v w θx θy θz of a place of an element, one row each, from its twelve coordinates.
template <class Scalar>
Eigen::Matrix<Scalar, 6, 12> place_shape(const std::type_identity_t<Scalar>& xi,
                                         const ElementForm<Scalar>& form) {
  Eigen::Matrix<Scalar, 6, 12> shape;
  shape.template topRows<3>() = axis_shape(xi, form);
  shape.row(3) = linear_row<Scalar>(3, xi);
  shape.row(4) = rotation_y_row(xi, form);
  shape.row(5) = rotation_z_row(xi, form);
  return shape;
}

}  // namespace pleuel
