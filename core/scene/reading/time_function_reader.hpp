#pragma once

#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/number_reader.hpp"
#include "core/scene/time_function.hpp"

/// Reads functions of time. All throw InputError.
namespace pleuel {

/// {"type": …, …}; the key "coordinate" may stand beside it.
/// @param value  what the drive prescribes: an angle or a length
TimeFunction read_drive_function(const JsonNode& node, const Quantity& value,
                                 NumberReader& numbers);

/// The same without the functions that are motions ("constant-speed", "ramp-to-speed"); a number, a
/// text with unit or a binding is a constant.
TimeFunction read_load_function(const JsonNode& node, const Quantity& value, NumberReader& numbers);

}  // namespace pleuel
