#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// Displacement [m] of a place of a beam in its body frame, so against its tangent or chord.
/// @param at         place along the undeformed length, 0 … 1
/// @param direction  1: local y, 2: local z
std::unique_ptr<Signal> make_deflection_signal(const BodyModel& body, double at, int direction);

/// Global coordinate [m] of a place of a beam, or of the reference point of another body.
/// @param direction  0 … 2: global x, y, z
std::unique_ptr<Signal> make_position_signal(const BodyModel& body, double at, int direction);

/// Torque [N m] that a drive exerts on the second body of its joint.
std::unique_ptr<Signal> make_drive_torque_signal(const JointModel& joint);

}  // namespace pleuel
