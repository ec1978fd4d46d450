#pragma once

#include <string>

#include "cli/text/json.hpp"
#include "core/response/monitors.hpp"

/// How far one simulated design can be trusted.
namespace pleuel {

/// {"position_drift", "velocity_drift", "energy_error", "elastic_rotation"} [SI]
Json monitors_document(const Monitors& monitors);

/// Sentences about constraints (if there are multipliers) and energy.
std::string monitors_text(const Monitors& monitors, int multipliers);

}  // namespace pleuel
