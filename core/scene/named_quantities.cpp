#include "core/scene/named_quantities.hpp"

#include <fmt/format.h>

namespace pleuel {

std::optional<Quantity> find_quantity(const std::string& unit) {
  for (const Quantity& quantity : named_quantities) {
    if (quantity.unit == unit) return quantity;
  }
  return std::nullopt;
}

std::optional<Quantity> find_quantity(const Dimension& dimension, const UnitSystem& units) {
  for (const Quantity& quantity : named_quantities) {
    if (units.measure(std::string(quantity.unit)).dimension == dimension) return quantity;
  }
  return std::nullopt;
}

std::string describe(const Dimension& dimension, const UnitSystem& units) {
  if (const auto quantity = find_quantity(dimension, units)) return describe(*quantity);
  return fmt::format("a quantity [{}]", base_units(dimension));
}

}  // namespace pleuel
