#pragma once

#include <numbers>

#include "core/section/section_properties.hpp"

namespace pleuel {

/// Solid circle, or tube with inner_diameter > 0. Exact.
template <class Scalar>
SectionProperties<Scalar> round_section(const Scalar& outer_diameter,
                                        const Scalar& inner_diameter) {
  const Scalar outer2 = outer_diameter * outer_diameter;
  const Scalar inner2 = inner_diameter * inner_diameter;
  SectionProperties<Scalar> section;
  section.area = std::numbers::pi / 4 * (outer2 - inner2);
  section.inertia_y = std::numbers::pi / 64 * (outer2 * outer2 - inner2 * inner2);
  section.inertia_z = section.inertia_y;
  section.torsion = 2.0 * section.inertia_y;
  const Scalar radius = outer_diameter / 2.0, zero(0);
  const Scalar shear = radius / section.torsion;
  section.radius_y = section.radius_z = radius;
  section.points = {
      {radius, zero, shear}, {-radius, zero, shear}, {zero, radius, shear}, {zero, -radius, shear}};
  // Q = 2/3 (R³ − r³), b = 2 (R − r): 4/3 (R² + R r + r²)/(R² + r²) V/A, from 4/3 to 2.
  const Scalar product = outer_diameter * inner_diameter;
  const Scalar peak = 4.0 / 3.0 / section.area * (outer2 + product + inner2) / (outer2 + inner2);
  section.shear_points = {{peak, peak, shear, false}};
  return section;
}

/// Solid ellipse, `width` along z, `height` along y: full axes [m]. Exact (Timoshenko & Goodier,
/// Theory of Elasticity, §106). With the semi-axes a (along y) and b (along z):
///     A = πab,   I_z = πa³b/4,   I_y = πab³/4,   J = πa³b³/(a² + b²)
///     shear per torque at the ends of the axes   2/(πa²b) at y = ±a,   2/(πab²) at z = ±b
/// and between them τ² = (τ_a cos θ)² + (τ_b sin θ)² at y = a cos θ, z = b sin θ.
template <class Scalar>
SectionProperties<Scalar> ellipse_section(const Scalar& width, const Scalar& height) {
  constexpr double pi = std::numbers::pi;
  const Scalar a = height / 2.0, b = width / 2.0, zero(0);
  const Scalar a2 = a * a, b2 = b * b;
  SectionProperties<Scalar> section;
  section.area = pi * a * b;
  section.inertia_y = section.area * b2 / 4.0;
  section.inertia_z = section.area * a2 / 4.0;
  section.torsion = section.area * a2 * b2 / (a2 + b2);
  section.radius_y = a;
  section.radius_z = b;
  const Scalar shear_at_y = 2.0 / (section.area * a), shear_at_z = 2.0 / (section.area * b);
  section.points = {
      {a, zero, shear_at_y}, {-a, zero, shear_at_y}, {zero, b, shear_at_z}, {zero, -b, shear_at_z}};
  // 4/3 V/A along the axes of the section, as of a circle; at their ends that of torsion is largest.
  const Scalar peak = 4.0 / 3.0 / section.area;
  section.shear_points = {
      {peak, peak, zero, false}, {peak, zero, shear_at_z}, {zero, peak, shear_at_y}};
  return section;
}

}  // namespace pleuel
