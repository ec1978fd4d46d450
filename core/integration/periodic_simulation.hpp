#pragma once

#include "core/integration/simulation_options.hpp"
#include "core/integration/trajectory.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// A simulation that starts from the motion that repeats itself after the period of the options, so
/// that there is no transient. With y = (q, v, a, w), all that a step of the scheme depends on, its
/// start is a zero of the change in a period, found by Newton's method (shooting: Nayfeh &
/// Balachandran 1995, ch. 5):
///     Y(y₀) − y₀ = 0,   Δy₀ = (1 − M)⁻¹ (Y(y₀) − y₀),   M = ∂Y/∂y₀  (period_map.hpp)
/// The discrete motion repeats itself, not only what it approximates; whole turns of frames in a
/// plane are left out. M is kept while it serves.
/// @throws SimulationError if something that acts does not repeat itself (repetition.hpp), if a
///         motion is free, unstable, or none is found
Trajectory simulate_periodic(Mechanism& mechanism, const SimulationOptions& options,
                             const InstantObserver& observer);

}  // namespace pleuel
