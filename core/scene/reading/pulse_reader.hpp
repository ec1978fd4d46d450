#pragma once

#include "core/scene/reading/law_source.hpp"

/// Reads laws that have a shape: steps, ramps, pulses. All throw InputError.
namespace pleuel {

/// From one value to another at a time; with "rise" by a quintic without rate and acceleration at
/// its ends, which drives need.
TableFunction read_step(const LawSource& source, NumberReader& numbers);

/// A straight line between two values; with "rounding" twice differentiable, which drives need.
RampFunction read_ramp(const LawSource& source, NumberReader& numbers);

/// Half a period of a sine; of loads only.
HalfSineFunction read_half_sine(const LawSource& source, NumberReader& numbers);

/// Up, a hold, and down. Flanks are straight, or quintics as those of a step, which drives need.
TableFunction read_trapezoid(const LawSource& source, NumberReader& numbers);

}  // namespace pleuel
