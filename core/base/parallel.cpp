#include "core/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pleuel {

int available_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

namespace {

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
