#pragma once

#include <memory>

#include "core/effects/body_equations.hpp"

namespace pleuel {

/// The equations for any motion, for motion in a plane where the frame turns by an angle, or for a
/// mass that does not turn.
/// @param frame, invariants  must outlive the result
std::unique_ptr<BodyEquations> make_body_equations(const BodyFrame& frame,
                                                   const Invariants<double>& invariants);
/// Likewise.
/// @param frame  must outlive the result
std::unique_ptr<DerivativeForces> make_derivative_forces(const BodyFrame& frame,
                                                         Invariants<double> derivative);

}  // namespace pleuel
