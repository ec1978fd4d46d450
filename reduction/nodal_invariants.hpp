#pragma once

#include "core/scene/body_constants.hpp"
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

}  // namespace pleuel
