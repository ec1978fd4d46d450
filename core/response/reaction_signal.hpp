#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// What is asked for of the wrench of a joint.
struct ReactionPart {
  enum class Kind { force, moment };
  Kind kind = Kind::force;
  int direction = 0;  ///< 0 … 2: global x, y, z, or magnitude_direction
};

/// What a joint, its drive included, exerts on its second body at that body's point of the joint:
///     force = −(∂Φ/∂P₂)ᵀ λ [N],    moment about the point = −(∂Φ/∂θ₂)ᵀ λ [N m]
/// Springs, dampers and motors in the joint are loads and no part of it.
///
/// In motion in a plane a joint carries the force in the plane and the moment normal to it. The
/// other components are zero here: so they are by symmetry, as long as bodies, joints and loads are
/// symmetric about the plane, which is what motion in a plane requires.
///
/// The signal is written in the numbers of the joint: local ones where the joint has a map, so that
/// a ProjectedSignal must lead there.
/// @param joint  must outlive the signal
std::unique_ptr<Signal> make_reaction_signal(const JointModel& joint, const ReactionPart& part);

}  // namespace pleuel
