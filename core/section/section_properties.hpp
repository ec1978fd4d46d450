#pragma once

#include <vector>

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

/// A place where shear stress of shear forces, with that of torsion, can be the largest. Where both
/// shear forces have directions of their own
///     τ = √((by_y V_y)² + (by_z V_z)²) + |T| by_torque
/// and where a wall has one direction
///     τ = |by_y V_y| + |by_z V_z| + |T| by_torque
/// of the worse of its symmetric places: where all of them add.
template <class Scalar>
struct ShearPoint {
  Scalar by_y, by_z;  ///< per shear force along y and z [1/m²]
  Scalar by_torque;   ///< [1/m³]
  bool is_in_wall = true;
};

template <class Scalar>
struct SectionProperties {
  Scalar area;       ///< A [m²]
  Scalar inertia_y;  ///< I_y = ∫z² dA [m⁴]
  Scalar inertia_z;  ///< I_z = ∫y² dA [m⁴]
  Scalar torsion;    ///< torsion constant J [m⁴]
  /// Half axes of a round outline, a circle or an ellipse (zero for others): it has no corners, and
  /// the place of the largest stress moves with the load (core/section/section_stress.hpp). Its
  /// points are the ends of the semi-axes: y, −y, z, −z.
  Scalar radius_y = Scalar(0), radius_z = Scalar(0);
  std::vector<StressPoint<Scalar>> points;
  /// By Jourawski's formula τ = V Q/(I b) (Gere & Timoshenko, Mechanics of Materials, ch. 5), which
  /// takes shear to be the same across the width b; none of sections that do not give them.
  std::vector<ShearPoint<Scalar>> shear_points;

  bool is_round() const { return radius_y > 0.0; }
};

// Timoshenko's shear coefficient κ, with which γ = V/(κ G A): the elastic solutions of Cowper
// (The shear coefficient in Timoshenko's beam theory, J. Appl. Mech. 33, 1966), in Poisson's ratio
// ν. Lengths in any one unit.

template <class Scalar>
Scalar rectangle_shear_coefficient(const Scalar& nu) {
  return 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
}

/// Circle, or tube with the ratio of inner to outer diameter.
template <class Scalar>
Scalar round_shear_coefficient(const Scalar& nu, const Scalar& ratio) {
  const Scalar square = ratio * ratio, sum = (1.0 + square) * (1.0 + square);
  return 6.0 * (1.0 + nu) * sum / ((7.0 + 6.0 * nu) * sum + (20.0 + 12.0 * nu) * square);
}

/// @param along, across  axes of the ellipse along the force and normal to it
template <class Scalar>
Scalar ellipse_shear_coefficient(const Scalar& nu, const Scalar& along, const Scalar& across) {
  const Scalar a2 = along * along, b2 = across * across;
  return 12.0 * (1.0 + nu) * a2 * (3.0 * a2 + b2) /
         ((40.0 + 37.0 * nu) * a2 * a2 + (16.0 + 10.0 * nu) * a2 * b2 + nu * b2 * b2);
}

/// Mean lines of a thin-walled box or I: flanges normal to the force, webs along it.
template <class Scalar>
struct ThinWalls {
  Scalar height, width;  ///< between mean lines of the flanges; of the flanges
  Scalar web, flange;    ///< thickness of one web, of one flange
};

template <class Scalar>
Scalar box_shear_coefficient(const Scalar& nu, const ThinWalls<Scalar>& s) {
  const Scalar m = s.width * s.flange / (s.height * s.web), n = s.width / s.height;
  const Scalar m2 = m * m, m3 = m2 * m, one = 1.0 + 3.0 * m;
  return 10.0 * (1.0 + nu) * one * one /
         ((12.0 + 72.0 * m + 150.0 * m2 + 90.0 * m3) +
          nu * (11.0 + 66.0 * m + 135.0 * m2 + 90.0 * m3) +
          10.0 * n * n * ((3.0 + nu) * m + 3.0 * m2));
}

/// Force along the web.
template <class Scalar>
Scalar i_shear_coefficient(const Scalar& nu, const ThinWalls<Scalar>& s) {
  const Scalar m = 2.0 * s.width * s.flange / (s.height * s.web), n = s.width / s.height;
  const Scalar m2 = m * m, m3 = m2 * m, one = 1.0 + 3.0 * m;
  return 10.0 * (1.0 + nu) * one * one /
         ((12.0 + 72.0 * m + 150.0 * m2 + 90.0 * m3) +
          nu * (11.0 + 66.0 * m + 135.0 * m2 + 90.0 * m3) + 30.0 * n * n * (m + m2) +
          5.0 * nu * n * n * (8.0 * m + 9.0 * m2));
}

}  // namespace pleuel
