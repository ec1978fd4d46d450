#pragma once

#include <memory>
#include <optional>

#include "core/model/model.hpp"
#include "core/response/body_frequency.hpp"

namespace pleuel {

/// The mechanism with all its modes, for natural frequencies: in space, with axial and torsional
/// elasticity, unreduced, and with whatever a tolerance leaves out of the motion. What leaves no
/// mode out (rotary inertia, geometric stiffening, elasticity as a whole) is as the file forces it.
struct FullMechanism {
  Model model;
  /// Where the whole mechanism's frequencies are asked for.
  std::optional<VibrationState> vibrating;
};

/// Whether a model is that already.
bool has_all_modes(const ProblemFile& problem, const Model& model);

/// The problem that the full mechanism is built from. A body with a moment of inertia about one
/// axis only, as motion in a plane allows, becomes a flat plate: half of it about the other two. Where damping
/// is asked for, beams with modal damping, which is that of their modes, stay reduced.
ProblemFile with_all_modes(const ProblemFile& problem);

/// Whether a response of a problem needs the initial state of the whole mechanism in space.
bool asks_for_mechanism_modes(const ProblemFile& problem);

/// @throws SimulationError if the mechanism cannot be started in space: a body that the plane holds
/// and nothing else may have no inertia out of it
std::unique_ptr<FullMechanism> make_full_mechanism(const ProblemFile& problem,
                                                   const Design<double>& start,
                                                   const Design<double>& design,
                                                   const Differentiation& differentiation);

}  // namespace pleuel
