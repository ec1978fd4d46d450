#pragma once

#include <memory>
#include <string>

#include "core/model/body_point.hpp"
#include "core/response/body_state.hpp"
#include "core/response/signal.hpp"

/// What can be observed of a point of a body. The model must outlive the signals.
namespace pleuel {

/// A point with its name for people: "at 0.5 of the length".
struct NamedPoint {
  BodyPoint point;
  std::string name;
};

/// Displacement [m] of a point in the body frame.
/// @param direction  0 … 2, local axes
std::unique_ptr<Signal> make_deflection_signal(const BodyModel& body, NamedPoint point,
                                               int direction);

/// A column of A, global axes, three channels: where local x, y or z of the body frame points.
/// @param axis  0 … 2
std::unique_ptr<Signal> make_axis_signal(const BodyModel& body, int axis);

/// The transmission angle [rad], 0 … π/2, at which one member pushes another: between the local x axes of
/// both body frames, or between that of one and the normal plane of a guide. At 0 it cannot push on: a dead centre,
/// where the number has a kink.
std::unique_ptr<Signal> make_transmission_angle(const BodyModel& first, const BodyModel& second);
std::unique_ptr<Signal> make_transmission_angle(const BodyModel& body,
                                                const Eigen::Vector3d& guide);

/// Angular velocity A ω [rad/s] or acceleration A α [rad/s²] of the body frame, global axes.
/// @param direction  0 … 2: global x, y, z, or magnitude_direction
/// @param derivative  first: velocity; second: acceleration
std::unique_ptr<Signal> make_spin_signal(const BodyModel& body, int direction,
                                         TimeDerivative derivative);

/// The angle [rad] about a global axis from global x (about x: y) to local x of the body frame (of
/// bodies that are no beams, about x: local y), right-handed. In a plane normal to the axis it
/// counts whole turns; else it is in (−π, π]. The signal throws SimulationError where the angle has
/// no value.
/// @param direction  0 … 2: global x, y, z
std::unique_ptr<Signal> make_angle_signal(const BodyModel& body, int direction);

/// Motion of a point in global axes. With p the point in the frame, displaced:
///     r + A p [m],    ṙ + Ȧ p + A ṗ [m/s],    r̈ + Ä p + 2 Ȧ ṗ + A p̈ [m/s²]
/// The acceleration is that of the true a, not the scheme's.
/// @param direction  0 … 2: global x, y, z, or magnitude_direction
std::unique_ptr<Signal> make_motion_signal(const BodyModel& body, NamedPoint point, int direction,
                                           TimeDerivative derivative);

}  // namespace pleuel
