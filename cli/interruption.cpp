#include "cli/interruption.hpp"

#include <array>
#include <csignal>

#include "core/base/stop.hpp"

namespace pleuel {

namespace {

constexpr std::array signals = {SIGINT, SIGTERM, SIGHUP};

extern "C" void record_interruption(int signal) {
  request_stop();
  std::signal(signal, SIG_DFL);
}

}  // namespace

Interruption::Interruption() {
  for (std::size_t i = 0; i < signals.size(); ++i) {
    before_[i] = std::signal(signals[i], record_interruption);
    // A program started in the background ignores interrupts, one of nohup the end of its terminal,
    // and shall go on doing so.
    if (before_[i] == SIG_IGN) std::signal(signals[i], SIG_IGN);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < signals.size(); ++i) std::signal(signals[i], before_[i]);
}

}  // namespace pleuel
