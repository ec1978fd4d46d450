#pragma once

#include <string>
#include <vector>

#include "cli/json.hpp"
#include "core/response/monitors.hpp"

/// How far one simulated design can be trusted.
namespace pleuel {

/// {"position_drift", "velocity_drift", "energy_error", "elastic_rotation"} [SI]
Json monitors_document(const Monitors& monitors);

/// Sentences about constraints (if there are multipliers) and energy.
std::string monitors_text(const Monitors& monitors, int multipliers);

/// "Warning: …" of each, in lines of their own.
std::string warnings_text(const std::vector<std::string>& warnings);

}  // namespace pleuel
