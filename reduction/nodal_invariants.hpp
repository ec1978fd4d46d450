#pragma once

#include "core/scene/body_constants.hpp"
#include "reduction/fixed_modes.hpp"
#include "reduction/solid_matrices.hpp"

namespace pleuel {

/// Mass and inertia, and the invariants of the elastic coordinates, from the mass matrix of the
/// finite elements alone (Zwölfer & Gerstmayr 2020, "A concise nodal-based derivation of the floating
/// frame of reference formulation for displacement-based solid finite elements"). Exact for elements
/// whose mass matrix is the same in all three directions, M = M_s ⊗ 1:
///     S̄ = Σ m ψ,   H_kl = x_kᵀ M_s ψ_l,   S_kl = ψ_kᵀ M_s ψ_l,   K_q = ψᵀ K ψ
/// @param positions  3 × nodes [m]
/// @param shape      ψ: displacements per coordinate, 3 nodes × n
/// @throws InputError if M is not of that form
BodyConstants nodal_invariants(const SolidMatrices& matrices, const Eigen::Matrix3Xd& positions,
                               const Eigen::MatrixXd& shape);

/// Without entries that are round-off: below 1e-15 of the largest one.
SparseMatrix sparse_of(const Eigen::MatrixXd& matrix);

/// Static deformations by the inertia of rigid accelerations, by the inertia of these deformations, and so on:
///     K r₁ = M r₀,   K r₂ = M r₁, …
/// made orthogonal one after the other (Gram–Schmidt), each with a mean square displacement of 1. They span a
/// Krylov space, which has what loads of slow accelerations do as well as modes have it (Wilson, Yuan & Dickens
/// 1982), and go continuously with the body, where modes change their order, and one leaves the lowest ones when
/// another enters. Scaled by displacements, and not by mass, they hardly change with a design at all.
///
/// @param rigid        r₀, a column each
/// @param generations  as many vectors as columns of r₀ each
/// @returns            squares are φᵀ K φ / φᵀ M φ: no frequencies, but above them
/// @throws InputError  if one has nothing that those before it have not
LowestModes inertia_responses(const StaticSolution& solve, const SolidMatrix& stiffness,
                              const SolidMatrix& mass, const Eigen::MatrixXd& rigid,
                              int generations);

}  // namespace pleuel
