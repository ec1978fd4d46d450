#pragma once

#include <cmath>

#include "core/base/dual.hpp"
#include "core/section/section_properties.hpp"

/// From the forces of a section to the stress at its points.
namespace pleuel {

/// Section forces in local axes, signed such that σ = N/A − M_z y/I_z + M_y z/I_y.
template <class Scalar>
struct SectionForces {
  Scalar axial = Scalar(0), moment_y = Scalar(0), moment_z = Scalar(0), torque = Scalar(0);
};

/// What forces and sections in two scalar types make: derivatives are those with respect to one of
/// them, the other is plain.
template <class Scalar, class Force>
using StressOf = decltype(Scalar() * Force());

/// Von Mises stress √(σ² + 3τ²) at a point [Pa].
template <class Scalar, class Force>
StressOf<Scalar, Force> von_mises_stress(const SectionProperties<Scalar>& section,
                                         const SectionForces<Force>& forces,
                                         const StressPoint<Scalar>& point) {
  using std::sqrt;
  constexpr double tiny = 1e-300;  // keeps the root differentiable at zero [Pa²]
  const StressOf<Scalar, Force> normal = forces.axial / section.area -
                                         forces.moment_z * point.y / section.inertia_z +
                                         forces.moment_y * point.z / section.inertia_y;
  const StressOf<Scalar, Force> shear = forces.torque * point.shear;
  return sqrt(normal * normal + 3.0 * shear * shear + tiny);
}

/// Points of a round outline that stay where they are: between two of them bending is larger by 0.9 % at
/// most.
inline constexpr int fixed_outline_points = 24;

/// The point of a round outline at the angle θ from y to z.
template <class Scalar>
StressPoint<Scalar> outline_point(const SectionProperties<Scalar>& section, double theta) {
  using std::sqrt;
  const Scalar &shear_y = section.points[0].shear, &shear_z = section.points[2].shear;
  const double c = std::cos(theta), s = std::sin(theta);
  return {section.radius_y * c, section.radius_z * s,
          sqrt(c * c * shear_y * shear_y + s * s * shear_z * shear_z)};
}

/// Stress along a round outline y = r_y cos θ, z = r_z sin θ:
///     σ = axial + bending_y cos θ + bending_z sin θ,   τ² = (shear_y cos θ)² + (shear_z sin θ)²
struct OutlineStress {
  double axial, bending_y, bending_z, shear_y, shear_z;
};

/// The angle of the largest von Mises stress on one half of the outline: where bending pulls, or
/// where it presses. On a circle that is where bending is largest; on an ellipse torsion draws it
/// towards the ends of the minor axis.
double angle_of_largest_stress(const OutlineStress& stress, bool where_bending_pulls);

/// The point of a round outline with the largest von Mises stress, on the half where bending pulls
/// or on the other one. Its angle is a plain number: the stress is stationary in it, so that a
/// derivative at fixed angle is that of the maximum (envelope theorem).
template <class Scalar, class Force>
StressPoint<Scalar> most_stressed_point(const SectionProperties<Scalar>& section,
                                        const SectionForces<Force>& forces,
                                        bool where_bending_pulls) {
  const Scalar &shear_y = section.points[0].shear, &shear_z = section.points[2].shear;
  const double torque = value_of(forces.torque);
  const double theta = angle_of_largest_stress(
      {value_of(forces.axial) / value_of(section.area),
       -value_of(forces.moment_z) * value_of(section.radius_y) / value_of(section.inertia_z),
       value_of(forces.moment_y) * value_of(section.radius_z) / value_of(section.inertia_y),
       torque * value_of(shear_y), torque * value_of(shear_z)},
      where_bending_pulls);
  return outline_point(section, theta);
}

}  // namespace pleuel
