#pragma once

#include <string>

#include "cli/reports/outcome.hpp"

namespace pleuel {

/// Why there is no outcome.
struct Failure {
  ExitCode code = ExitCode::fault;
  std::string message;  ///< with the file, the place in it and the rule, as far as they are known
  bool is_stopped = false;  ///< the user ended it
};

/// What the exception that is being handled means to the user. To be called from a handler.
Failure current_failure();

}  // namespace pleuel
