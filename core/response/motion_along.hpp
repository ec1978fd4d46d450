#pragma once

#include <Eigen/Core>

#include "core/model/model.hpp"

/// Which vibrations are motion along one axis: most of their kinetic energy is.
namespace pleuel {

/// M_d with vᵀ M_d v = ∫ρ (d·ṗ)² for a unit vector d; those of x, y and z add up to the mass matrix.
/// Of the elastic coordinates of a body, in its own axes: ∫ρ (d·S)ᵀ (d·S), n × n; zero where the
/// constants of the body know no motion along it.
Eigen::MatrixXd elastic_mass_along(const Invariants<double>& body, const Eigen::Vector3d& d);

/// The same of all coordinates of a mechanism in a state, in global axes. With e = Aᵀd, a
/// point p = p₀ + S q_f of a body moves along d at
///     d·ṙ + (p × e)·ω + e·S q̇_f
/// and the integrals of products of these are invariants (core/beam/invariants.hpp).
Eigen::MatrixXd mass_along(const Model& model, const State& state, const Eigen::Vector3d& d);

/// Of modes that coincide, the combinations that move along an axis as much, or as little, as can be:
/// those that are modes along it, with more than half of their kinetic energy. It tells apart bending
/// in two planes where both have the same frequency.
/// @param modes  k of them, one a column
/// @param mass   of all motion, n × n
/// @param along  M_d of the axis
/// @return T, k × p, with Tᴴ (modesᴴ mass modes) T = 1: modes · T are along the axis
Eigen::MatrixXcd combinations_along(const Eigen::MatrixXcd& modes, const Eigen::MatrixXd& mass,
                                    const Eigen::MatrixXd& along);

}  // namespace pleuel
