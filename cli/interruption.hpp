#pragma once

namespace pleuel {

/// While it lives, an interrupt from the keyboard (SIGINT) or a request to end (SIGTERM) stops what
/// is computed (check_stop()), for a command to end in good order with what it knows; a second one
/// ends the program at once.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

 private:
  using Handler = void (*)(int);
  Handler before_interrupt_, before_end_;
};

}  // namespace pleuel
