#pragma once

#include "core/model/model.hpp"
#include "core/response/mechanism_modes.hpp"
#include "core/scene/mode_choice.hpp"

namespace pleuel {

/// Vectors of one eigenvalue of a frozen mechanism and of all that coincide with it, one a column:
/// P φ = 0, ψᴴ P = 0 with multipliers (pencil_at()).
struct ModalVectors {
  std::complex<double> s;
  Eigen::MatrixXcd right, left;                          ///< n × k
  Eigen::MatrixXcd right_multipliers, left_multipliers;  ///< m × k
};

/// @param modes  modes_of(frozen)
/// @param mode   from 0, one of them
ModalVectors modal_vectors(const FrozenMechanism& frozen, const Eigen::VectorXcd& modes, int mode);

/// A mechanism that is frozen in a state, with its modes.
struct FrozenModes {
  const Model& model;
  State state;
  FrozenMechanism frozen;
  Eigen::VectorXcd modes;  ///< modes_of(frozen)

  FrozenModes(const Model& frozen_model, const State& at, bool is_damped = false);
};

/// Which of the modes of a mechanism is meant; of those that coincide the first. Only those that
/// vibrate have a damping ratio.
/// @param choice  its axis is a global one
/// @throws InputError `the mechanism has … natural frequencies …, not …`
int find_mode(const FrozenModes& mechanism, const ModeChoice& choice);

}  // namespace pleuel
