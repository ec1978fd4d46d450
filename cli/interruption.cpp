#include "cli/interruption.hpp"

#include <csignal>

#include "core/base/stop.hpp"

namespace pleuel {

namespace {

extern "C" void record_interruption(int signal) {
  request_stop();
  std::signal(signal, SIG_DFL);
}

}  // namespace

Interruption::Interruption() {
  before_interrupt_ = std::signal(SIGINT, record_interruption);
  before_end_ = std::signal(SIGTERM, record_interruption);
  // A program started in the background ignores interrupts, and shall go on doing so.
  if (before_interrupt_ == SIG_IGN) std::signal(SIGINT, SIG_IGN);
}

Interruption::~Interruption() {
  std::signal(SIGINT, before_interrupt_);
  std::signal(SIGTERM, before_end_);
}

}  // namespace pleuel
