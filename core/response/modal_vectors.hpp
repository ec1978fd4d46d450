#pragma once

/// Which vibrations are motion along one axis: most of their kinetic energy is.

#include <array>

#include <Eigen/Core>

#include "core/linear/modes.hpp"
#include "core/model/model.hpp"
#include "core/scene/mode_choice.hpp"

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

/// What is asked for of a mode, and its derivative with respect to s along a change of it.
double number_of(ModeNumber of, std::complex<double> s);
double change_of_number(ModeNumber of, std::complex<double> s, std::complex<double> change);

/// Vectors of one eigenvalue of a linearized mechanism and of all that coincide with it, one a column:
/// P φ = 0, ψᴴ P = 0 with multipliers (pencil_at()).
struct ModalVectors {
  std::complex<double> s;
  Eigen::MatrixXcd right, left;                          ///< n × k
  Eigen::MatrixXcd right_multipliers, left_multipliers;  ///< m × k
};

/// @param modes  modes_of(linearized)
/// @param mode   from 0, one of them
ModalVectors modal_vectors(const Linearization& linearized, const Eigen::VectorXcd& modes,
                           int mode);

/// A growth rate is counted with the rotor; a ratio, which is that of a whirl as it is seen, and what
/// moves along an axis are not.
MotionAxes::Kind axes_of(const ModeChoice& choice);

/// A mechanism that is linearized in a state, with its modes.
struct LinearizedModes {
  const Model& model;
  State state;
  MotionAxes axes;
  Linearization linearized;
  Eigen::VectorXcd modes;  ///< modes_of(linearized)

  LinearizedModes(const Model& of_model, const State& at, bool is_damped, MotionAxes::Kind kind);

  /// mass_along() of what is counted in these axes.
  Eigen::MatrixXd mass_along(const std::array<double, 3>& d) const;
};

/// Which of the modes of a mechanism is meant; of those that coincide the first. Only those that
/// vibrate have a damping ratio.
/// @param choice  its axis is a global one
/// @throws InputError `the mechanism has … natural frequencies …, not …`
int find_mode(const LinearizedModes& mechanism, const ModeChoice& choice);

}  // namespace pleuel
