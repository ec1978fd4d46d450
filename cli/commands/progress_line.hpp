#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "cli/input/arguments.hpp"
#include "core/base/stopwatch.hpp"

namespace pleuel {

/// "  uncertainty: 192 of 1000 samples, 3.1 s, about 13 s left"
/// @param seconds  so far
/// @param left     [s], if it can be told
std::string progress_text(const std::string& what, double seconds, std::optional<double> left);

/// A line that says what is going on and how long that still takes, while it takes longer than two
/// seconds: on standard error, if that is a terminal and no JSON is asked for, else nowhere. It is
/// gone when the work is done.
class ProgressLine {
 public:
  ProgressLine(const Arguments& arguments, std::string what);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// What is done now, and how much of all of it, 0 … 1: the rest takes as long for as much.
  void show_share(std::string what, double share);

  /// What is done now, and how long it is expected to take from here on [s].
  void expect(std::string what, double seconds);

  /// A line of text that stays, wherever standard error leads.
  void print(const std::string& line);

  /// Whether there is anybody to look at it.
  bool is_shown() const { return is_shown_; }

 private:
  void keep_up_to_date();
  void set(std::string what, double end);
  void erase() const;
  void draw() const;

  const bool is_shown_;
  const Stopwatch stopwatch_;
  std::mutex mutex_;
  std::condition_variable change_;
  bool is_over_ = false;
  std::string what_;
  std::optional<double> end_;  ///< expected, on the stopwatch [s]
  std::thread thread_;
};

}  // namespace pleuel
