#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// Displacement [m] of a place of a beam in its body frame, so against its tangent or chord.
/// @param at         place along the undeformed length, 0 … 1
/// @param direction  1: local y, 2: local z
std::unique_ptr<Signal> make_deflection_signal(const BodyModel& body, double at, int direction);

/// The same against the straight line through both ends of the beam, whatever its frame.
std::unique_ptr<Signal> make_chord_deflection_signal(const BodyModel& body, double at,
                                                     int direction);

/// Motion of a place of a beam, or of the reference point of another body, in global axes.
struct PlaceMotion {
  double at = 0.0;    ///< along the undeformed length, 0 … 1; beams only
  int direction = 0;  ///< 0 … 2: global x, y, z; −1: magnitude
};

/// A column of A, global axes, three channels: where local x, y or z of the body frame points.
/// @param axis  0 … 2
std::unique_ptr<Signal> make_axis_signal(const BodyModel& body, int axis);

/// With p the place in the frame (undeformed place and elastic displacement):
///     r + A p [m]
std::unique_ptr<Signal> make_position_signal(const BodyModel& body, const PlaceMotion& motion);

///     ṙ + Ȧ p + A ṗ [m/s]
std::unique_ptr<Signal> make_velocity_signal(const BodyModel& body, const PlaceMotion& motion);

///     r̈ + Ä p + 2 Ȧ ṗ + A p̈ [m/s²]: of the true acceleration a, not the scheme's
std::unique_ptr<Signal> make_acceleration_signal(const BodyModel& body, const PlaceMotion& motion);

}  // namespace pleuel
