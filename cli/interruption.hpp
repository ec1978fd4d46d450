#pragma once

namespace pleuel {

/// While it lives, an interrupt from the keyboard (SIGINT) or a request to end (SIGTERM) is only
/// noted, for a long command to end in good order; a second one ends the program at once.
class Interruption {
 public:
  struct Asked {};

  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// @throws Asked
  void check() const;

 private:
  using Handler = void (*)(int);
  Handler before_interrupt_, before_end_;
};

}  // namespace pleuel
