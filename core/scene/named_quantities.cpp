#include "core/scene/named_quantities.hpp"

#include <fmt/format.h>

namespace pleuel {

std::optional<Quantity> find_quantity(const std::string& unit) {
  for (const Quantity& quantity : named_quantities) {
    if (quantity.unit == unit) return quantity;
  }
  return std::nullopt;
}

Dimension dimension_of(const Quantity& quantity) {
  return measure_unit(std::string(quantity.unit)).dimension;
}

std::optional<Quantity> find_quantity(const Dimension& dimension) {
  for (const Quantity& quantity : named_quantities) {
    if (dimension_of(quantity) == dimension) return quantity;
  }
  return std::nullopt;
}

std::string describe(const Dimension& dimension) {
  if (const auto quantity = find_quantity(dimension)) return describe(*quantity);
  return fmt::format("a quantity [{}]", base_units(dimension));
}

}  // namespace pleuel
