#include "core/base/stop.hpp"

#include <atomic>

namespace pleuel {

namespace {

/// A signal reaches the whole process, so this is of the process, too.
std::atomic<bool> is_asked = false;
static_assert(std::atomic<bool>::is_always_lock_free, "signals may store nothing else");

}  // namespace

void request_stop() noexcept {
  is_asked.store(true, std::memory_order_relaxed);
}

void withdraw_stop() noexcept {
  is_asked.store(false, std::memory_order_relaxed);
}

void check_stop() {
  if (is_asked.load(std::memory_order_relaxed)) throw Stopped{};
}

}  // namespace pleuel
