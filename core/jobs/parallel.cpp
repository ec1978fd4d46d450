#include "core/jobs/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

#include <sched.h>

namespace pleuel {

namespace {

/// As processors are, the limit is of the whole process.
std::atomic<int> thread_limit = std::numeric_limits<int>::max();

int usable_processors() {
  cpu_set_t usable;
  if (::sched_getaffinity(0, sizeof usable, &usable) == 0) return CPU_COUNT(&usable);
  return static_cast<int>(std::thread::hardware_concurrency());  // of more than 1024
}

/// What the call with the smallest number threw.
class FirstFailure {
 public:
  void note(int i, std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    if (failure_ && i_ < i) return;
    i_ = i;
    failure_ = std::move(failure);
  }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::mutex mutex_;
  int i_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

int available_threads() {
  return std::min(std::max(1, usable_processors()), thread_limit.load());
}

void limit_threads(int most) {
  thread_limit = std::max(1, most);
}

void for_each_in_parallel(int count, int threads, const std::function<void(int)>& work) {
  std::atomic<int> next = 0;
  FirstFailure failure;
  const auto run = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        failure.note(i, std::current_exception());
        next = count;
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < std::min(threads, count); ++i) others.emplace_back(run);
    run();
  }
  failure.rethrow();
}

}  // namespace pleuel
