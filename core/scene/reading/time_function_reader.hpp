#pragma once

#include "core/scene/reading/law_source.hpp"

/// Reads functions of time, and of the state of a force element. All throw InputError.
namespace pleuel {

/// {"type": …, …}; the key "coordinate" may stand beside it.
/// @param value  what the drive prescribes: an angle or a length
TimeFunction read_drive_function(const JsonNode& node, const Quantity& value,
                                 NumberReader& numbers);

/// The motion that a motor follows: the same without other keys.
TimeFunction read_target(const JsonNode& node, const Quantity& value, NumberReader& numbers);

/// The same without the functions that are motions ("constant-speed", "ramp-to-speed"); a number, a
/// text with unit or a binding is a constant, a formula may have t and the state in it.
TimeFunction read_load_function(const LawSource& source, NumberReader& numbers);

/// What springs and dampers resist with: a function of the state, or "friction" or "clearance".
TimeFunction read_resistance(const LawSource& source, NumberReader& numbers);

}  // namespace pleuel
