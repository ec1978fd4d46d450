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

}  // namespace pleuel
