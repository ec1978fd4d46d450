#pragma once

#include <string>

#include "core/model/model.hpp"

namespace pleuel {

/// What linear elasticity in a body frame is estimated to be off by, relative to the largest of the
/// same kind in the beam.
struct GeometricError {
  double deflection = 0.0;  ///< transverse displacement, against the tangent or chord of the frame
  double position = 0.0;    ///< along the beam: of the shortening, or of the length without one
  double rotation = 0.0;    ///< of nodes
  double curvature = 0.0;   ///< so of the stress of bending and torsion
  double strain = 0.0;  ///< |ε|: stretched by 1 %, a beam is some 1 % longer than E A was made for

  double largest() const;
  /// What is off most: "its deflection".
  std::string most() const;
};

/// One step of a geometrically exact beam from the linear solution. The strains of the state
/// (curvatures κ, elongation ε) are integrated without linearization,
///     R' = R κ̃,   r' = (1 + ε) R e_x,
/// the loads that the linear equations hold in equilibrium keep their directions in the frame, Q,
/// and their moments change with the places they act at,
///     M' = −r' × Q,   κ₁ = κ + D⁻¹ (Rᵀ M − D κ),   ε₁ = ε + ((RᵀQ)_x − N)/EA
/// The error is the difference of what κ₁, ε₁ integrate to and of the displacements of the state.
/// It is right to leading order, the square of rotations (Simo 1985 for the equations of the beam).
/// Loads of an unstiffened model are Q = (N, V); with geometric stiffening they are in equilibrium
/// with the slope, Q = (N, V + N v'), and the axial displacement holds the shortening.
/// @param nodal  displacements against the frame, 6 × nodes (nodal_displacements())
GeometricError estimate_geometric_error(const BodyModel& body, const Eigen::MatrixXd& nodal);

}  // namespace pleuel
