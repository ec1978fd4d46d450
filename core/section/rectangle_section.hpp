#pragma once

#include <cmath>
#include <numbers>

#include "core/base/dual.hpp"
#include "core/section/section_properties.hpp"

namespace pleuel {

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
  // 3/2 V/A in the middle, and in the middle of the sides, where that of torsion is largest.
  const Scalar peak = 1.5 / section.area;
  section.shear_points = {
      {peak, peak, zero, false}, {peak, zero, shear_at_z}, {zero, peak, shear_at_y}};
  return section;
}

}  // namespace pleuel
