#pragma once

#include "core/scene/reading/json_node.hpp"

namespace pleuel {

/// A relative error: a tolerance of one or more asks for nothing. @throws InputError
inline double read_tolerance(const JsonNode& node) {
  if (node.number() <= 0.0 || node.number() >= 1.0) {
    node.fail_with_value("must be greater than 0 and less than 1");
  }
  return node.number();
}

}  // namespace pleuel
