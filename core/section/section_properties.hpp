#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/dual.hpp"

/// Properties of cross-sections in any scalar type, so that dual numbers give exact derivatives.
///
/// Axes: x along the beam, y and z in the section, origin in the centroid; y and z are principal.
namespace pleuel {

/// A point where normal stress and torsional shear stress are evaluated:
///     σ = N/A − M_z y/I_z + M_y z/I_y,    τ = shear · T
template <class Scalar>
struct StressPoint {
  Scalar y, z;   ///< [m]
  Scalar shear;  ///< [1/m³]
};

template <class Scalar>
struct SectionProperties {
  Scalar area;       ///< A [m²]
  Scalar inertia_y;  ///< I_y = ∫z² dA [m⁴]
  Scalar inertia_z;  ///< I_z = ∫y² dA [m⁴]
  Scalar torsion;    ///< torsion constant J [m⁴]
  /// Round sections have no corners: the resultant moment acts at `radius` (zero otherwise).
  Scalar radius = Scalar(0);
  std::vector<StressPoint<Scalar>> points;
};

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
  section.radius = outer_diameter / 2.0;
  const Scalar shear = section.radius / section.torsion;
  const Scalar zero(0);
  section.points = {{section.radius, zero, shear},
                    {-section.radius, zero, shear},
                    {zero, section.radius, shear},
                    {zero, -section.radius, shear}};
  return section;
}

/// Torsion of a rectangle with sides `longer` ≥ `shorter` by Saint-Venant's series (Timoshenko &
/// Goodier, Theory of Elasticity, §109). Per unit torque, with a = longer, b = shorter:
///     J = a b³/3 · (1 − 192 b/(π⁵ a) Σ tanh(nπa/2b)/n⁵),   n = 1, 3, 5 …
///     shear in the middle of the longer side   b/J · (1 − 8/π² Σ 1/(n² cosh(nπa/2b)))
///     shear in the middle of the shorter side  8b/(π²J) Σ (−1)^((n−1)/2) tanh(nπa/2b)/n²
template <class Scalar>
struct RectangleTorsion {
  Scalar constant;       ///< J [m⁴]
  Scalar longer_shear;   ///< [1/m³]
  Scalar shorter_shear;  ///< [1/m³]
};

template <class Scalar>
RectangleTorsion<Scalar> rectangle_torsion(const Scalar& longer, const Scalar& shorter) {
  using std::exp;
  constexpr double pi = std::numbers::pi;
  const Scalar ratio = longer / shorter;
  // Sums without the hyperbolic functions, which are the remainders of 1 with e^(−nπa/b):
  // Σ 1/n⁵ (n odd) = 31/32 ζ(5), Σ (−1)^((n−1)/2)/n² = Catalan's constant.
  constexpr double sum_n5 = 31.0 / 32.0 * 1.036927755143369926;
  constexpr double catalan = 0.915965594177219015;
  Scalar constant_sum(sum_n5), longer_sum(0), shorter_sum(catalan);
  for (int n = 1; n <= 25; n += 2) {
    const Scalar decay = exp(-n * pi * ratio);
    const Scalar one_minus_tanh = 2.0 * decay / (1.0 + decay);
    const Scalar half_decay = exp(-n * pi / 2 * ratio);
    const double n2 = double(n) * n;
    constant_sum -= one_minus_tanh / (n2 * n2 * n);
    longer_sum += 2.0 * half_decay / (n2 * (1.0 + decay));
    shorter_sum -= ((n % 4 == 1) ? 1.0 : -1.0) * one_minus_tanh / n2;
  }
  RectangleTorsion<Scalar> torsion;
  torsion.constant = longer * shorter * shorter * shorter / 3.0 *
                     (1.0 - 192.0 / std::pow(pi, 5) * constant_sum / ratio);
  torsion.longer_shear = shorter / torsion.constant * (1.0 - 8.0 / (pi * pi) * longer_sum);
  torsion.shorter_shear = shorter / torsion.constant * (8.0 / (pi * pi)) * shorter_sum;
  return torsion;
}

/// Solid rectangle, `width` along z, `height` along y [m].
template <class Scalar>
SectionProperties<Scalar> rectangle_section(const Scalar& width, const Scalar& height) {
  const bool is_tall = value_of(height) >= value_of(width);
  const RectangleTorsion<Scalar> torsion =
      is_tall ? rectangle_torsion(height, width) : rectangle_torsion(width, height);
  SectionProperties<Scalar> section;
  section.area = width * height;
  section.inertia_y = height * width * width * width / 12.0;
  section.inertia_z = width * height * height * height / 12.0;
  section.torsion = torsion.constant;
  const Scalar y = height / 2.0, z = width / 2.0, zero(0);
  // The middle of the sides at ±y lies on the longer side if the rectangle is wide.
  const Scalar shear_at_y = is_tall ? torsion.shorter_shear : torsion.longer_shear;
  const Scalar shear_at_z = is_tall ? torsion.longer_shear : torsion.shorter_shear;
  section.points = {{y, z, zero},          {y, -z, zero},         {-y, z, zero},
                    {-y, -z, zero},        {y, zero, shear_at_y}, {-y, zero, shear_at_y},
                    {zero, z, shear_at_z}, {zero, -z, shear_at_z}};
  return section;
}

}  // namespace pleuel
