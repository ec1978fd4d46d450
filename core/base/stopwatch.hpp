#pragma once

#include <chrono>
#include <ctime>

namespace pleuel {

/// Wall time since it was made.
class Stopwatch {
 public:
  /// [s]
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Processor time of this thread since it was made, in the same thread.
class ThreadStopwatch {
 public:
  /// [s]
  double seconds() const { return now() - begin_; }

 private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double begin_ = now();
};

}  // namespace pleuel
