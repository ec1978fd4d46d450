#pragma once

#include <stdexcept>
#include <string>

#include "include/pleuel.h"

namespace pleuel {

/// A C function was called in a way that it cannot be: the message says which argument is wrong, and how.
class CallError : public std::runtime_error {
 public:
  explicit CallError(const std::string& text, pleuel_status status = PLEUEL_BAD_CALL)
      : std::runtime_error(text), status(status) {}

  pleuel_status status;
};

}  // namespace pleuel
