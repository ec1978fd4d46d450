#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// What a response measures: mass [kg], stress [Pa], deflection and position [m], drive torque
/// [N m]; an integral over time multiplies by [s]. `.unit` is the SI unit of values and limits.
Quantity quantity_of(const ResponseSettings& response);

/// The quantity of the integral over time of what a response measures: "Pa s".
Quantity times_time(const Quantity& quantity);

}  // namespace pleuel
