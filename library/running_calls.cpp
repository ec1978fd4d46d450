#include "library/running_calls.hpp"

#include <atomic>

#include "core/base/stop.hpp"

namespace pleuel {

namespace {

std::atomic<int> running = 0;

}  // namespace

RunningCall::RunningCall() noexcept {
  if (running.fetch_add(1) == 0) withdraw_stop();
}

RunningCall::~RunningCall() {
  running.fetch_sub(1);
}

}  // namespace pleuel
