#include "core/scene/named_quantities.hpp"

namespace pleuel {

std::optional<Quantity> find_quantity(const std::string& unit) {
  for (const Quantity& quantity : named_quantities) {
    if (quantity.unit == unit) return quantity;
  }
  return std::nullopt;
}

}  // namespace pleuel
