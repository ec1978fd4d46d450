#pragma once

#include "core/section/section_properties.hpp"

namespace pleuel {

/// Torsion of an I with flanges b × f and a web of thickness w, square corners. Strips, four free
/// ends and two junctions, as El Darwish & Johnston 1965 (Torsion of structural shapes, J. Struct.
/// Div. ASCE 91, ST1) put it together:
///     J = 2 b f³/3 + (h − 2f) w³/3 − 4 · 0.105 f⁴ + 2 α f⁴
/// Their α(w/f) is up to 1 % of J off without fillets; this one, and the shear at the middle of the
/// flange f (1 + …), are polynomials of our own through finite elements, for w ≤ 3f.
///
/// Error of J against finite elements: 0.15 % at most if flanges stick out by 1.5f, 0.35 % if by f
/// only, for a web longer than it is thick. The stress peak in the inner corners, which depends on
/// their rounding, is left out. So is warping: a flange that cannot warp freely is stiffer.
template <class Scalar>
struct ITorsion {
  Scalar constant;        ///< J [m⁴]
  Scalar flange_shear;    ///< per torque [1/m³]
  Scalar web_shear;       ///< [1/m³]
  Scalar junction_shear;  ///< outside of the flange, opposite to the web [1/m³]
};

template <class Scalar>
ITorsion<Scalar> i_torsion(const Scalar& width, const Scalar& height, const Scalar& flange,
                           const Scalar& web) {
  constexpr double end = 0.105040;  // of a strip: (1/3) · 0.63025/2, see rectangle_torsion
  const Scalar ratio = web / flange, ratio2 = ratio * ratio;
  const Scalar junction =
      ratio2 * (0.14706 + ratio * (0.22167 + ratio * (-0.07341 - 0.00337 * ratio)));
  const Scalar bulge = 1.0 + ratio2 * (0.16845 + ratio * (0.01064 - 0.00615 * ratio));
  const Scalar flange3 = flange * flange * flange;
  ITorsion<Scalar> torsion;
  torsion.constant = 2.0 / 3.0 * width * flange3 + (height - 2.0 * flange) * web * web * web / 3.0 +
                     (2.0 * junction - 4.0 * end) * flange3 * flange;
  torsion.flange_shear = flange / torsion.constant;
  torsion.web_shear = web / torsion.constant;
  torsion.junction_shear = bulge * torsion.flange_shear;
  return torsion;
}

/// I-section, web along y, flanges along z; `width` and `height` are outer [m]. Area and second
/// moments are exact for square corners. Its points are the outer corners of the flanges with the
/// shear of the flange, the middles of the flanges, and the ends of the web.
template <class Scalar>
SectionProperties<Scalar> i_section(const Scalar& width, const Scalar& height,
                                    const Scalar& flange_thickness, const Scalar& web_thickness) {
  const Scalar web_height = height - 2.0 * flange_thickness;
  const auto inertia = [](const Scalar& base, const Scalar& depth) -> Scalar {
    return base * depth * depth * depth / 12.0;
  };
  const ITorsion<Scalar> torsion = i_torsion(width, height, flange_thickness, web_thickness);
  SectionProperties<Scalar> section;
  section.area = 2.0 * width * flange_thickness + web_height * web_thickness;
  section.inertia_y =
      inertia(Scalar(2.0 * flange_thickness), width) + inertia(web_height, web_thickness);
  section.inertia_z = inertia(width, height) - inertia(Scalar(width - web_thickness), web_height);
  section.torsion = torsion.constant;
  const Scalar y = height / 2.0, z = width / 2.0, zero(0);
  const Scalar web_y = web_height / 2.0, web_z = web_thickness / 2.0;
  section.points = {{y, z, torsion.flange_shear},       {y, -z, torsion.flange_shear},
                    {-y, z, torsion.flange_shear},      {-y, -z, torsion.flange_shear},
                    {y, zero, torsion.junction_shear},  {-y, zero, torsion.junction_shear},
                    {web_y, web_z, torsion.web_shear},  {web_y, -web_z, torsion.web_shear},
                    {-web_y, web_z, torsion.web_shear}, {-web_y, -web_z, torsion.web_shear}};
  // Web: Q of half the section in its middle. Flange: where it meets the web, from both forces.
  const Scalar arm = (height - flange_thickness) / 2.0;
  const Scalar half_web = web_height / 2.0;
  const Scalar in_web = width * flange_thickness * arm + web_thickness * half_web * half_web / 2.0;
  const Scalar overhang = (width - web_thickness) / 2.0;
  section.shear_points = {{in_web / (section.inertia_z * web_thickness), zero, torsion.web_shear},
                          {overhang * arm / section.inertia_z,
                           width * width / (8.0 * section.inertia_y), torsion.junction_shear}};
  return section;
}

}  // namespace pleuel
