#include "core/scene/dimension_quantity.hpp"

#include <fmt/format.h>

namespace pleuel {

bool has_dimension(const Quantity& quantity, const Dimension& dimension, const UnitSystem& units) {
  return units.measure(std::string(quantity.unit)).dimension == dimension;
}

std::optional<Quantity> find_quantity(const Dimension& dimension, const UnitSystem& units) {
  using namespace quantities;
  for (const Quantity& quantity : {pure_number,
                                   length,
                                   mass,
                                   inertia,
                                   density,
                                   stress,
                                   torque,
                                   time,
                                   rate,
                                   angle,
                                   angular_speed,
                                   speed,
                                   acceleration,
                                   force,
                                   power,
                                   area,
                                   second_moment_of_area,
                                   torsional_shear,
                                   spring_stiffness,
                                   damping_constant,
                                   torsional_stiffness,
                                   torsional_damping}) {
    if (has_dimension(quantity, dimension, units)) return quantity;
  }
  return std::nullopt;
}

std::string describe(const Dimension& dimension, const UnitSystem& units) {
  if (const auto quantity = find_quantity(dimension, units)) return describe(*quantity);
  return fmt::format("a quantity [{}]", base_units(dimension));
}

}  // namespace pleuel
