#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/scene/dimension.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// What a measured number is called, one quantity a dimension: what is found for a unit or a
/// dimension is the first that has it.
inline constexpr std::array named_quantities = {quantities::pure_number,
                                                quantities::length,
                                                quantities::mass,
                                                quantities::inertia,
                                                quantities::density,
                                                quantities::stress,
                                                quantities::torque,
                                                quantities::time,
                                                quantities::rate,
                                                quantities::angle,
                                                quantities::angular_speed,
                                                quantities::speed,
                                                quantities::acceleration,
                                                quantities::force,
                                                quantities::power,
                                                quantities::area,
                                                quantities::second_moment_of_area,
                                                quantities::torsional_shear,
                                                quantities::spring_stiffness,
                                                quantities::damping_constant,
                                                quantities::torsional_stiffness,
                                                quantities::torsional_damping};

/// The quantity of a number of a scene that has this SI unit, if there is one.
std::optional<Quantity> find_quantity(const std::string& unit);

Dimension dimension_of(const Quantity& quantity);

/// The quantity that numbers of the file with this dimension have, if it has a name: of m² kg s⁻²
/// "a torque [N m]".
std::optional<Quantity> find_quantity(const Dimension& dimension);

/// "a length [m]", "a number without unit"; of a quantity without name "a quantity [kg m]".
std::string describe(const Dimension& dimension);

}  // namespace pleuel
