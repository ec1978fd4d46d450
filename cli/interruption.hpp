#pragma once

#include <array>

#include "cli/reports/outcome.hpp"

namespace pleuel {

/// While it lives, an interrupt from the keyboard (SIGINT), a request to end (SIGTERM) or the end of
/// the terminal (SIGHUP) stops what is computed (check_stop()), for a command to end in good order with what it knows; a second one
/// ends the program at once.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

 private:
  using Handler = void (*)(int);
  std::array<Handler, 3> before_;
};

/// Why there is no outcome.
struct Failure {
  ExitCode code = ExitCode::fault;
  std::string message;  ///< with the file, the place in it and the rule, as far as they are known
  bool is_stopped = false;  ///< the user ended it
};

/// What the exception that is being handled means to the user. To be called from a handler.
Failure current_failure();

}  // namespace pleuel
