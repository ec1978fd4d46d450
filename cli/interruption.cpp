#include "cli/interruption.hpp"

#include <csignal>

namespace pleuel {

namespace {

volatile std::sig_atomic_t is_asked = 0;

extern "C" void note_interruption(int signal) {
  is_asked = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

Interruption::Interruption() {
  is_asked = 0;
  before_interrupt_ = std::signal(SIGINT, note_interruption);
  before_end_ = std::signal(SIGTERM, note_interruption);
  // A program started in the background ignores interrupts, and shall go on doing so.
  if (before_interrupt_ == SIG_IGN) std::signal(SIGINT, SIG_IGN);
}

Interruption::~Interruption() {
  std::signal(SIGINT, before_interrupt_);
  std::signal(SIGTERM, before_end_);
}

void Interruption::check() const {
  if (is_asked != 0) throw Asked{};
}

}  // namespace pleuel
