#pragma once

#include <array>

#include "core/beam/beam.hpp"
#include "core/beam/beam_shape.hpp"
#include "core/frame/body_frame.hpp"
#include "core/section/section_stress.hpp"

namespace pleuel {

/// Section forces of a beam element: those of its strain (N = EA Δu/ℓ, M = EI v″) and what the
/// inertia load does between its nodes.
/// @param q              twelve coordinates of the element
/// @param elongation     Δu, with or without the shortening by bending [m]
/// @param accelerations  of its nodes against free fall, local axes
/// @param xi             place in the element, 0 … 1
template <class Scalar>
SectionForces<Scalar> element_forces(const BeamElement<Scalar>& element,
                                     const Eigen::Matrix<Scalar, 12, 1>& q,
                                     const Scalar& elongation,
                                     const std::array<Vector3<Scalar>, 2>& accelerations,
                                     double xi) {
  const Scalar& length = element.length;
  const SectionProperties<Scalar>& section = element.section;
  // What the linear load w = w₁ + ξ Δ does in a clamped element: EI v″ and EA u' with M″ = w,
  // N' = −w, and no displacement at the ends.
  const Scalar density = -element.density * section.area;
  const Vector3<Scalar> start = density * accelerations[0];
  const Vector3<Scalar> change = density * (accelerations[1] - accelerations[0]);
  const Vector3<Scalar> clamped =
      (length * length) * ((xi * xi / 2 - xi / 2 + 1.0 / 12) * start +
                           (xi * xi * xi / 6 - 3 * xi / 20 + 1.0 / 30) * change);
  const Scalar clamped_axial =
      length * ((0.5 - xi) * start(0) - (xi * xi / 2 - 1.0 / 6) * change(0));
  const auto h = hermite(xi, length, 2);

  SectionForces<Scalar> forces;
  forces.axial = element.young * section.area * elongation / length + clamped_axial;
  const Scalar curvature_y = h[0] * q(1) + h[1] * q(5) + h[2] * q(7) + h[3] * q(11);
  const Scalar curvature_z = h[0] * q(2) - h[1] * q(4) + h[2] * q(8) - h[3] * q(10);
  forces.moment_z = element.young * section.inertia_z * curvature_y + clamped(1);
  forces.moment_y = -(element.young * section.inertia_y * curvature_z + clamped(2));
  forces.torque = element.shear * section.torsion * (q(9) - q(3)) / length;
  return forces;
}

}  // namespace pleuel
