#pragma once

#include <stdexcept>

namespace pleuel {

/// A C function was called in a way that it cannot be: the message says which argument is wrong, and how.
class CallError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pleuel
