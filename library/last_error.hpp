#pragma once

#include <string>

#include "include/pleuel.h"

namespace pleuel {

/// An error of a C function, taken apart.
struct CallFailure {
  pleuel_status kind = PLEUEL_FAULT;
  std::string file, pointer, rule, text;
};

/// Takes a message "file: /pointer rule, got value" apart, as far as it is one.
CallFailure divided(pleuel_status kind, const std::string& message);

/// Keeps what the exception that is being handled means as the last error of this thread. To be
/// called from a handler.
/// @param file  of the problem that the call was about; empty: messages name it, or there is none
/// @returns     its kind
pleuel_status keep_failure(const std::string& file) noexcept;

/// Of this thread.
const pleuel_error* last_error() noexcept;

}  // namespace pleuel
