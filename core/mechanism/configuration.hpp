#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/system/system.hpp"

/// Configurations q whose rotation vectors are composed, not added. `rotations` lists the first
/// coordinate of each (Mechanism::rotations); everything else in q is an ordinary coordinate.
namespace pleuel {

using Rotations = std::vector<int>;

/// q = start ⊕ increment. q is not start.
void advance(const Rotations& rotations, const Eigen::VectorXd& start,
             const Eigen::VectorXd& increment, Eigen::VectorXd& q);

/// The increment that leads from start to q.
Eigen::VectorXd difference(const Rotations& rotations, const Eigen::VectorXd& q,
                           const Eigen::VectorXd& start);

/// The step increments Δ change q by right perturbations T(Δ) δΔ: adds q_weight · R_q (T − I) to a
/// step matrix.
/// @param R_q  tangent with weight one on q
void add_increment_tangent(const Rotations& rotations, const Eigen::VectorXd& increment,
                           const System::Matrix& R_q, double q_weight, System::Matrix& matrix);

// Sensitivities of q⁺ = q ⊕ Δ:  s_q⁺ = exp(−Δ̃) s_q + T(Δ) s_Δ = T(Δ) (T(Δ)⁻ᵀ s_q + s_Δ).

/// s ← T(Δ)⁻ᵀ s in the rows of each rotation.
void pull_back(const Rotations& rotations, const Eigen::VectorXd& increment, Eigen::MatrixXd& s);

/// s ← T(Δ) s in the rows of each rotation.
void push_forward(const Rotations& rotations, const Eigen::VectorXd& increment, Eigen::MatrixXd& s);

// And the transposed ones, for adjoints: s ← T(Δ)⁻¹ s, s ← T(Δ)ᵀ s.
void pull_back_transposed(const Rotations& rotations, const Eigen::VectorXd& increment, Columns s);
void push_forward_transposed(const Rotations& rotations, const Eigen::VectorXd& increment,
                             Columns s);

}  // namespace pleuel
