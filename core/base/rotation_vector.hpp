#pragma once

#include <Eigen/Core>

#include "core/base/small_matrices.hpp"

/// Rotations in space by rotation vectors. The rotation of a frame is A = exp(ψ̃); its rates are the
/// angular velocity ω and acceleration α in body axes; small changes δ are right perturbations
///     A ⊕ δ = A exp(δ̃)
/// so that nothing is singular and planar motion adds angles (Brüls & Cardona 2010).
namespace pleuel {

/// exp(ψ̃) (Rodrigues).
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& psi);

/// The ψ of a rotation matrix with |ψ| ≤ π.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation);

/// ψ ⊕ δ: the vector of exp(ψ̃) exp(δ̃), composed by Euler parameters.
Eigen::Vector3d compose(const Eigen::Vector3d& psi, const Eigen::Vector3d& delta);

/// T(δ) of  exp((δ + ε)~) = exp(δ̃) exp((T ε)~) + O(ε²):
///     T = I − (1 − cos φ)/φ² δ̃ + (φ − sin φ)/φ³ δ̃δ̃,   φ = |δ|
Eigen::Matrix3d tangent_operator(const Eigen::Vector3d& delta);

/// T(δ)⁻¹ for |δ| < 2π.
Eigen::Matrix3d inverse_tangent_operator(const Eigen::Vector3d& delta);

}  // namespace pleuel
