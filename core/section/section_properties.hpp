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

}  // namespace pleuel
