#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/place_kinematics.hpp"
#include "core/response/signal.hpp"

/// What can be observed of bodies that are known by their invariants. The model must outlive the
/// signals.
namespace pleuel {

/// Position, velocity or acceleration of a place.
/// @param direction  0 … 2 global axes, or the magnitude
std::unique_ptr<Signal> make_imported_motion_signal(const BodyModel& body, const std::string& place,
                                                    int direction, TimeDerivative derivative);

/// Displacement of a place in the body frame [m].
/// @param direction  0 … 2, local axes
std::unique_ptr<Signal> make_imported_deflection_signal(const BodyModel& body,
                                                        const std::string& place, int direction);

}  // namespace pleuel
