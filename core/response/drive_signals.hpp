#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// −λ of a drive's equation: the torque [N m] about the joint's axis that a drive of an angle
/// exerts on the second body of its joint, or the force [N] along the axis (of a distance: along
/// the connection) of a drive of a displacement.
std::unique_ptr<Signal> make_drive_effort_signal(const JointModel& joint);

/// −λ ḟ(t) [W]: what the drive f(t) supplies to the mechanism, −λᵀ ∂Φ/∂t.
/// @param joint  must outlive the signal
std::unique_ptr<Signal> make_drive_power_signal(const JointModel& joint);

}  // namespace pleuel
