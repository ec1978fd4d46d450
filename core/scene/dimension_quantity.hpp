#pragma once

#include <optional>
#include <string>

#include "core/scene/dimension.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// The quantity that numbers of the file with this dimension have, if it has a name: of m² kg s⁻²
/// "a torque [N m]".
std::optional<Quantity> find_quantity(const Dimension& dimension, const UnitSystem& units);

/// "a length [m]", "a number without unit"; of a quantity without name "a quantity [kg m]".
std::string describe(const Dimension& dimension, const UnitSystem& units);

/// Whether a unit has this dimension. @pre the unit is known
bool has_dimension(const Quantity& quantity, const Dimension& dimension, const UnitSystem& units);

}  // namespace pleuel
