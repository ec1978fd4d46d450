#pragma once

#include <array>
#include <vector>

#include "core/beam/beam.hpp"

namespace pleuel {

/// The two planes in which a beam may bend.
enum class BendingPlane { xy, xz };

/// What joints hold at a node against motion out of the plane of bending.
struct LateralSupport {
  bool deflection = false, slope = false, twist = false;
};

/// Section forces in the plane of bending, one entry an element.
struct PlaneLoad {
  std::vector<double> axial;                  ///< N [N], pull is positive
  std::vector<std::array<double, 2>> moment;  ///< at both ends of the element [N m]
};

/// By what factor section forces in one plane make a beam buckle out of it. With the lateral
/// deflection w and the twist φ, the lateral stiffness EI and I₀ = I_y + I_z (Timoshenko & Gere,
/// Theory of Elastic Stability, ch. 5 and 6),
///     Π = ½ ∫ EI w''² + GJ φ'² + s (N w'² + N (I₀/A) φ'² + 2 m M φ w'') dx,
/// the smallest s > 0 at which Π is no longer positive; infinite if there is none. Columns, beams
/// whose moment twists them sideways (M = π √(EI GJ)/L for a constant one), and both together.
/// m² = 1 − EI/EI_bending, as bending in the plane holds the beam straighter out of it (Kirby &
/// Nethercot 1979); equal stiffness leaves m = 0. Warping of sections is free, transverse loads act
/// at the centroid.
/// @param supports  one a node; @returns NaN if they let the beam move freely
double lateral_load_factor(const Beam<double>& beam, BendingPlane plane,
                           const std::vector<LateralSupport>& supports, const PlaneLoad& load);

}  // namespace pleuel
