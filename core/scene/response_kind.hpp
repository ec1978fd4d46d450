#pragma once

#include <string_view>
#include <vector>

#include "core/scene/response_settings.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// A word for a response, and what is to be known of it without looking at its settings.
struct ResponseKind {
  std::string_view word;  ///< in a problem file
  /// At an instant. What a part, a coordinate or a formula decides, quantity_of() knows.
  Quantity quantity;
  AnyResponse made;  ///< with its defaults
};

/// In the order of the schema.
const std::vector<ResponseKind>& response_kinds();

const ResponseKind& kind_of(const AnyResponse& response);

}  // namespace pleuel
