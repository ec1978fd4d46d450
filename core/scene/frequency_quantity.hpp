#pragma once

#include "core/scene/units.hpp"

namespace pleuel::quantities {

/// Of a vibration: a number is in rad/s, and "40 Hz" is 40 cycles of 2π rad in a second. An angular
/// speed takes no Hz.
inline constexpr Quantity angular_frequency{"a frequency", "rad/s"};

}  // namespace pleuel::quantities
