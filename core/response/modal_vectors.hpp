#pragma once

#include "core/linear/modes.hpp"
#include "core/model/model.hpp"
#include "core/scene/mode_choice.hpp"

namespace pleuel {

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

/// A mechanism that is linearized in a state, with its modes.
struct LinearizedModes {
  const Model& model;
  State state;
  Linearization linearized;
  Eigen::VectorXcd modes;  ///< modes_of(linearized)

  LinearizedModes(const Model& of_model, const State& at, bool is_damped = false);
};

/// Which of the modes of a mechanism is meant; of those that coincide the first. Only those that
/// vibrate have a damping ratio.
/// @param choice  its axis is a global one
/// @throws InputError `the mechanism has … natural frequencies …, not …`
int find_mode(const LinearizedModes& mechanism, const ModeChoice& choice);

}  // namespace pleuel
