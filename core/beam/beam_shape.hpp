#pragma once

#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "core/base/dual.hpp"
#include "core/base/element_place.hpp"
#include "core/base/int_size.hpp"
#include "core/beam/beam.hpp"

namespace pleuel {

/// What shapes an element between its nodes: its length, and how far shear bends it.
///
/// Timoshenko's beam without loads between its nodes has a cubic deflection v, and a shear angle
/// γ = v' − θ that is the same all along, with θ the rotation of the sections. EI θ'' + κGA γ = 0 and
/// the cubic with the slopes θ₁ + γ and θ₂ + γ at its ends give
///     γ = s ((v₂ − v₁)/ℓ − (θ₁ + θ₂)/2),   s = Φ/(1 + Φ),   Φ = 12 EI/(κGA ℓ²)
/// (Przemieniecki, Theory of Matrix Structural Analysis, 1968, §5.6; Friedman & Kosmatka 1993). So the
/// shapes are Euler and Bernoulli's, of end slopes that differ from the rotations of the sections by
/// γ. Without shear s = 0.
template <class Scalar>
struct ElementForm {
  Scalar length;                                    ///< ℓ [m]
  Scalar shear_y = Scalar(0), shear_z = Scalar(0);  ///< s of deflections along y and z [–]
};

template <class Scalar>
ElementForm<Scalar> form_of(const BeamElement<Scalar>& element) {
  const Scalar& length = element.length;
  const auto share = [&](const Scalar& inertia, const Scalar& compliance) {
    if (value_of(compliance) == 0.0) return Scalar(0);
    const Scalar phi = 12.0 * element.young * inertia * compliance / (length * length);
    return Scalar(phi / (1.0 + phi));
  };
  return {length, share(element.section.inertia_z, element.shear_compliance_y),
          share(element.section.inertia_y, element.shear_compliance_z)};
}

// Shape functions of the 3D beam element: the one source of its mass, stiffness, inertia shape
// integrals and recovery.
//
// Element coordinates (12): u v w θx θy θz at the first node, then at the second, in local axes.
// A material point (x, y, z) is displaced by
//     u = u₀ − y θz + z θy,   v = v₀ − z θx,   w = w₀ + y θx
// with u₀, θx linear and v₀, w₀ cubic in ξ = x/ℓ; θz = v₀' − γy, θy = −(w₀' − γz) with the shear
// angles γ of core/beam/beam_shape.hpp, zero where shear does not bend the element.

inline constexpr int element_coordinates = 12;

template <class Scalar>
using ElementShape = Eigen::Matrix<Scalar, 3, element_coordinates>;
template <class Scalar>
using ElementRow = Eigen::Matrix<Scalar, 1, element_coordinates>;

/// Hermite polynomials for (v₁, v'₁, v₂, v'₂), differentiated `order` times with respect to x.
template <class Scalar>
std::array<Scalar, 4> hermite(const std::type_identity_t<Scalar>& xi, const Scalar& length,
                              int order = 0) {
  switch (order) {
    case 0:
      return {Scalar(1.0 - 3.0 * xi * xi + 2.0 * xi * xi * xi),
              Scalar(length * (xi - 2.0 * xi * xi + xi * xi * xi)),
              Scalar(3.0 * xi * xi - 2.0 * xi * xi * xi),
              Scalar(length * (xi * xi * xi - xi * xi))};
    case 1:
      return {Scalar((6.0 * xi * xi - 6.0 * xi) / length), Scalar(1.0 - 4.0 * xi + 3.0 * xi * xi),
              Scalar((6.0 * xi - 6.0 * xi * xi) / length), Scalar(3.0 * xi * xi - 2.0 * xi)};
    default:
      return {Scalar((12.0 * xi - 6.0) / (length * length)), Scalar((6.0 * xi - 4.0) / length),
              Scalar((6.0 - 12.0 * xi) / (length * length)), Scalar((6.0 * xi - 2.0) / length)};
  }
}

/// ∫ v₀'² dx of the Hermite cubic with end displacements v₁, v₂ = v₁ + `difference` and slopes.
template <class Scalar>
Scalar slope_integral(const Scalar& difference, const Scalar& first_slope,
                      const Scalar& second_slope, const Scalar& length) {
  return 1.2 * difference * difference / length - 0.2 * difference * (first_slope + second_slope) +
         length / 15.0 *
             (2.0 * first_slope * first_slope - first_slope * second_slope +
              2.0 * second_slope * second_slope);
}

/// Coefficients of deflection and rotation at both ends (v₁, θ₁, v₂, θ₂) in one plane of bending.
template <class Scalar>
using BendingRow = std::array<Scalar, 4>;

/// γ.
/// @param shear  s of the plane
template <class Scalar>
BendingRow<Scalar> shear_angle(const Scalar& length, const Scalar& shear) {
  const Scalar of_deflection = shear / length, of_rotation = -0.5 * shear;
  return {Scalar(-of_deflection), of_rotation, of_deflection, of_rotation};
}

/// The deflection of the axis, differentiated `order` times: the cubic with the end slopes θ + γ.
template <class Scalar>
BendingRow<Scalar> deflection(const std::type_identity_t<Scalar>& xi, const Scalar& length,
                              const Scalar& shear, int order) {
  BendingRow<Scalar> row = hermite(xi, length, order);
  if (value_of(shear) == 0.0) return row;
  const Scalar of_angle = row[1] + row[3];
  const BendingRow<Scalar> angle = shear_angle(length, shear);
  for (std::size_t i = 0; i < 4; ++i) row[i] += of_angle * angle[i];
  return row;
}

/// The rotation of the section, v' − γ.
template <class Scalar>
BendingRow<Scalar> section_rotation(const std::type_identity_t<Scalar>& xi, const Scalar& length,
                                    const Scalar& shear) {
  BendingRow<Scalar> row = deflection(xi, length, shear, 1);
  if (value_of(shear) == 0.0) return row;
  const BendingRow<Scalar> angle = shear_angle(length, shear);
  for (std::size_t i = 0; i < 4; ++i) row[i] -= angle[i];
  return row;
}

/// A row of the x–y plane (v, θz) in the twelve coordinates.
template <class Scalar>
ElementRow<Scalar> row_along_y(const BendingRow<Scalar>& bending) {
  ElementRow<Scalar> row = ElementRow<Scalar>::Constant(Scalar(0));
  row(1) = bending[0];
  row(5) = bending[1];
  row(7) = bending[2];
  row(11) = bending[3];
  return row;
}

/// A row of the x–z plane (w, −θy) in the twelve coordinates.
template <class Scalar>
ElementRow<Scalar> row_along_z(const BendingRow<Scalar>& bending) {
  ElementRow<Scalar> row = ElementRow<Scalar>::Constant(Scalar(0));
  row(2) = bending[0];
  row(4) = -bending[1];
  row(8) = bending[2];
  row(10) = -bending[3];
  return row;
}

/// Row of v₀ (in the x–y plane), differentiated `order` times.
template <class Scalar>
ElementRow<Scalar> deflection_y_row(const std::type_identity_t<Scalar>& xi,
                                    const ElementForm<Scalar>& form, int order = 0) {
  return row_along_y(deflection(xi, form.length, form.shear_y, order));
}

/// Row of w₀ (in the x–z plane), differentiated `order` times.
template <class Scalar>
ElementRow<Scalar> deflection_z_row(const std::type_identity_t<Scalar>& xi,
                                    const ElementForm<Scalar>& form, int order = 0) {
  return row_along_z(deflection(xi, form.length, form.shear_z, order));
}

/// Row of θz.
template <class Scalar>
ElementRow<Scalar> rotation_z_row(const std::type_identity_t<Scalar>& xi,
                                  const ElementForm<Scalar>& form) {
  return row_along_y(section_rotation(xi, form.length, form.shear_y));
}

/// Row of θy.
template <class Scalar>
ElementRow<Scalar> rotation_y_row(const std::type_identity_t<Scalar>& xi,
                                  const ElementForm<Scalar>& form) {
  return -row_along_z(section_rotation(xi, form.length, form.shear_z));
}

/// Row of γy = v₀' − θz.
template <class Scalar>
ElementRow<Scalar> shear_y_row(const ElementForm<Scalar>& form) {
  return row_along_y(shear_angle(form.length, form.shear_y));
}

/// Row of γz = w₀' + θy.
template <class Scalar>
ElementRow<Scalar> shear_z_row(const ElementForm<Scalar>& form) {
  return row_along_z(shear_angle(form.length, form.shear_z));
}

/// Linear interpolation of the coordinates `first` and `first` + 6 (0: u₀, 3: θx).
template <class Scalar>
ElementRow<Scalar> linear_row(int first, const std::type_identity_t<Scalar>& xi) {
  ElementRow<Scalar> row = ElementRow<Scalar>::Constant(Scalar(0));
  row(first) = Scalar(1.0 - xi);
  row(first + 6) = Scalar(xi);
  return row;
}

/// Displacement of the beam axis.
template <class Scalar>
ElementShape<Scalar> axis_shape(const std::type_identity_t<Scalar>& xi,
                                const ElementForm<Scalar>& form) {
  ElementShape<Scalar> shape;
  shape.row(0) = linear_row<Scalar>(0, xi);
  shape.row(1) = deflection_y_row(xi, form);
  shape.row(2) = deflection_z_row(xi, form);
  return shape;
}

/// Displacement per unit y of an off-axis point: (−θz, 0, θx).
template <class Scalar>
ElementShape<Scalar> y_offset_shape(const std::type_identity_t<Scalar>& xi,
                                    const ElementForm<Scalar>& form) {
  ElementShape<Scalar> shape = ElementShape<Scalar>::Constant(Scalar(0));
  shape.row(0) = -rotation_z_row(xi, form);
  shape.row(2) = linear_row<Scalar>(3, xi);
  return shape;
}

/// Displacement per unit z of an off-axis point: (θy, −θx, 0).
template <class Scalar>
ElementShape<Scalar> z_offset_shape(const std::type_identity_t<Scalar>& xi,
                                    const ElementForm<Scalar>& form) {
  ElementShape<Scalar> shape = ElementShape<Scalar>::Constant(Scalar(0));
  shape.row(0) = rotation_y_row(xi, form);
  shape.row(1) = -linear_row<Scalar>(3, xi);
  return shape;
}

/// Gauss–Legendre points on [0, 1]: exact for polynomials of degree 7, so for every integral of a
/// product of two shape functions here.
struct GaussPoint {
  double xi, weight;
};
inline constexpr std::array<GaussPoint, 4> gauss_points = {{
    {0.069431844202973712, 0.173927422568726929},
    {0.330009478207571868, 0.326072577431273071},
    {0.669990521792428132, 0.326072577431273071},
    {0.930568155797026288, 0.173927422568726929},
}};

/// Ĝ of an element in its twelve coordinates: ∫ v₀'² + w₀'² dx = qᵀ Ĝ q.
template <class Scalar>
Eigen::Matrix<Scalar, 12, 12> slope_matrix(const ElementForm<Scalar>& form) {
  using Matrix = Eigen::Matrix<Scalar, 12, 12>;
  Matrix matrix = Matrix::Constant(Scalar(0));
  for (const GaussPoint& point : gauss_points) {
    const auto v = deflection_y_row(point.xi, form, 1);
    const auto w = deflection_z_row(point.xi, form, 1);
    matrix += (point.weight * form.length) * (v.transpose() * v + w.transpose() * w);
  }
  return matrix;
}

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
