#pragma once

#include <chrono>
#include <ctime>
#include <functional>
#include <limits>
#include <vector>

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

// What one piece of work costs beside another, on a machine that does other things, too.

/// The processor time of one of several works.
struct ComparedTime {
  double seconds = 0.0;  ///< median [s]
  double change = 0.0;   ///< median of (its time / that of the first work in the same round − 1)
  /// Half of what the median is expected within; infinite where it was measured too seldom.
  double spread = std::numeric_limits<double>::infinity();

  /// Whether the works differ by more than what times of the same work do.
  bool is_measurable() const { return change > spread || change < -spread; }
};

/// How long works are compared.
struct TimingBudget {
  double seconds = 1.0;  ///< of all rounds
  double most = 30.0;    ///< of seven rounds, if they take longer than that
  /// Processor time of this thread [s].
  std::function<double()> clock = {};
};

/// Does all works in turns (A B C A B C …), after a first round that only warms up: seven rounds, and
/// more until the budget ends. Each round compares works within moments, so that what slows the
/// machine down slows all of them. The spread is that of the sign test (David & Nagaraja, Order
/// Statistics, 2003, ch. 7): the median lies between the smallest and the largest of seven rounds but
/// in 1.6 % of all cases; of many rounds within a part of them but in 0.4 %. It is infinite where the
/// most that may be spent ends before seven rounds.
/// @returns one a work; changes are relative to the first
std::vector<ComparedTime> compare_times(const std::vector<std::function<void()>>& works,
                                        const TimingBudget& budget = {});

}  // namespace pleuel
