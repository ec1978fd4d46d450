#pragma once

#include <array>

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

}  // namespace pleuel
