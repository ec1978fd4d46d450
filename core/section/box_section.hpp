#pragma once

#include <cmath>
#include <numbers>

#include "core/section/section_properties.hpp"

namespace pleuel {

/// Torsion of a rectangular tube with square corners and walls of one thickness t, in Prandtl's
/// stress function φ (∇²φ = −2, zero outside, φ_h over the hole). With ψ harmonic between 1 on the
/// hole and 0 outside, φ = φ_h ψ + φ₀, and by Green's theorem
///     J = 4A²/C + 2∫φ₀ dA,   C = ∮∂ψ/∂n ds,   A = hole + ∫ψ dA,   φ_h = 2A/C
/// Bredt's formula takes C and A from the mean line. Here they are those of straight walls and four
/// corners, with P = 2(b + h − 4t) around the hole b_i × h_i:
///     C = P/t + 4 (1 − 2 ln 2/π),   A = b_i h_i + P t/2 + 4 · 0.1449 t²,
///     2∫φ₀ = P t³/3 + 4 · 0.405 t⁴
/// The corner of C is that of the conformal map of a right-angled bend; the other two are numbers
/// of our own, by finite elements. Shear in the middle of the walls: φ_h/t + t, per twist.
///
/// Error against finite elements (sides 1:1 to 1:4): J within 0.01 % for t up to a quarter of the
/// shorter side, −1.3 % at worst where the hole vanishes; shear never more than 0.6 % too small,
/// and too large by 0.5 % at a fifth of the shorter side, up to 27 % without a hole. The stress
/// peak in the inner corners, which depends on their rounding, is left out, and so is warping.
template <class Scalar>
struct BoxTorsion {
  Scalar constant;  ///< J [m⁴]
  Scalar shear;     ///< of the walls, per torque [1/m³]
};

template <class Scalar>
BoxTorsion<Scalar> box_torsion(const Scalar& width, const Scalar& height, const Scalar& thickness) {
  constexpr double corner_conductance = 1.0 - 2.0 * std::numbers::ln2 / std::numbers::pi;
  constexpr double corner_area = 0.1449, corner_stiffness = 0.405;
  const Scalar& t = thickness;
  const Scalar inner_width = width - 2.0 * t, inner_height = height - 2.0 * t;
  const Scalar perimeter = 2.0 * (inner_width + inner_height);
  const Scalar conductance = perimeter / t + 4.0 * corner_conductance;
  const Scalar area = inner_width * inner_height + perimeter * t / 2.0 + 4.0 * corner_area * t * t;
  const Scalar at_hole = 2.0 * area / conductance;
  BoxTorsion<Scalar> torsion;
  torsion.constant =
      2.0 * area * at_hole + (perimeter / 3.0 + 4.0 * corner_stiffness * t) * t * t * t;
  torsion.shear = (at_hole / t + t) / torsion.constant;
  return torsion;
}

/// Shear flow in the walls of a box that are along a shear force V (`depth` along it, `across` it)
/// and in those across it, over V: q = V Q/I of half the section. With the distance s of half the
/// depth from the middle
///     q(s) = q(0) − t s²/(2 I),   q(0) = (B H² − b h²)/(16 I)
/// and in the walls across linear from zero in their middle to q at the corner.
template <class Scalar>
struct BoxShear {
  Scalar depth, across, thickness, inertia;

  /// Shear stress in a wall along the force, at a share of half the depth between the walls.
  Scalar along(double share) const {
    const Scalar inner = depth - 2.0 * thickness, inner_across = across - 2.0 * thickness;
    const Scalar s = share * inner / 2.0;
    const Scalar moment = (across * depth * depth - inner_across * inner * inner) / 16.0;
    return moment / (thickness * inertia) - s * s / (2.0 * inertia);
  }
  /// In a wall across it, at a share of half the width between the walls.
  Scalar sideways(double share) const {
    return share * (across - 2.0 * thickness) / 2.0 * (depth - thickness) / (2.0 * inertia);
  }
};

/// Places along half a wall: that of the largest shear lies between its middle and the corner where
/// both shear forces act. What is between two of them is larger by 1 % at most.
template <class Scalar>
std::vector<ShearPoint<Scalar>> box_shear_points(const SectionProperties<Scalar>& section,
                                                 const Scalar& width, const Scalar& height,
                                                 const Scalar& thickness, const Scalar& torsion) {
  const BoxShear<Scalar> by_y{height, width, thickness, section.inertia_z};
  const BoxShear<Scalar> by_z{width, height, thickness, section.inertia_y};
  std::vector<ShearPoint<Scalar>> points;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    points.push_back({by_y.along(share), by_z.sideways(share), torsion});
    points.push_back({by_y.sideways(share), by_z.along(share), torsion});
  }
  return points;
}

/// Rectangular tube, `width` along z, `height` along y, outer [m]. Area and second moments are
/// exact. Its points are the outer corners with the shear of the walls: in the very corner there is
/// none, but it is there within a wall thickness, where bending is nearly as large.
template <class Scalar>
SectionProperties<Scalar> box_section(const Scalar& width, const Scalar& height,
                                      const Scalar& thickness) {
  const Scalar inner_width = width - 2.0 * thickness, inner_height = height - 2.0 * thickness;
  const auto inertia = [](const Scalar& base, const Scalar& depth) -> Scalar {
    return base * depth * depth * depth / 12.0;
  };
  const BoxTorsion<Scalar> torsion = box_torsion(width, height, thickness);
  SectionProperties<Scalar> section;
  section.area = 2.0 * thickness * (width + inner_height);
  section.inertia_y = inertia(height, width) - inertia(inner_height, inner_width);
  section.inertia_z = inertia(width, height) - inertia(inner_width, inner_height);
  section.torsion = torsion.constant;
  const Scalar y = height / 2.0, z = width / 2.0;
  section.points = {{y, z, torsion.shear},
                    {y, -z, torsion.shear},
                    {-y, z, torsion.shear},
                    {-y, -z, torsion.shear}};
  section.shear_points = box_shear_points(section, width, height, thickness, torsion.shear);
  return section;
}

}  // namespace pleuel
