#pragma once

#include <cstdint>
#include <functional>
#include <random>

#include "reduction/solid_matrices.hpp"

namespace pleuel {

/// Whole numbers up to 2³², the same in every run: no chance decides over a result (Numerical Recipes, §7.1).
using RepeatedChance = std::linear_congruential_engine<std::uint32_t, 1664525U, 1013904223U, 0>;

/// Modes K φ = ω² M φ, the lowest first; φᵀ M φ = 1.
struct LowestModes {
  Eigen::VectorXd squares;  ///< ω² [rad²/s²]
  Eigen::MatrixXd shapes;
};

/// Applies K⁻¹, within what is held.
using StaticSolution = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& load)>;

/// The lowest modes by block Lanczos on K⁻¹ M with all vectors orthogonalized again (Golub & Van Loan,
/// Matrix Computations, §10.3.6): a block finds modes of the same frequency, as those of a square bar.
/// Relative error of ω² below 1e-10, by the residual.
///
/// @param count  at least so many
/// @param mass   M, both triangles
/// @throws SimulationError if they are not found
LowestModes lowest_modes(const StaticSolution& solve, const SolidMatrix& mass, int count);

}  // namespace pleuel
