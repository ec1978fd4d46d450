#include "cli/commands/progress_line.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/text/console.hpp"

namespace pleuel {

namespace {

/// Work that is shorter needs no line.
constexpr double patience = 2.0;  // [s]
constexpr std::chrono::milliseconds refresh(500);

/// Of a time that is a guess anyway: "13 s", "4 min", "2 h".
std::string rough_duration(double seconds) {
  if (seconds < 100.0) return fmt::format("{:.0f} s", std::max(1.0, seconds));
  if (seconds < 6000.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.0f} h", seconds / 3600.0);
}

}  // namespace

std::string progress_text(const std::string& what, double seconds, std::optional<double> left) {
  const std::string end = left ? fmt::format(", about {} left", rough_duration(*left)) : "";
  return fmt::format("  {}, {}{}", what, rough_duration(seconds), end);
}

ProgressLine::ProgressLine(const Arguments& arguments, std::string what)
    : is_shown_(!arguments.wants_json && ::isatty(STDERR_FILENO) == 1), what_(std::move(what)) {
  if (is_shown_) thread_ = std::thread([this] { keep_up_to_date(); });
}

ProgressLine::~ProgressLine() {
  if (!is_shown_) return;
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  change_.notify_all();
  thread_.join();
}

void ProgressLine::show_share(std::string what, double share) {
  const double seconds = stopwatch_.seconds();
  set(std::move(what), share > 0.0 ? seconds / std::min(1.0, share) : seconds);
}

void ProgressLine::expect(std::string what, double seconds) {
  set(std::move(what), stopwatch_.seconds() + seconds);
}

void ProgressLine::print(const std::string& line) {
  const std::lock_guard lock(mutex_);
  if (is_shown_) erase();
  show(stderr, line + "\n");
}

void ProgressLine::set(std::string what, double end) {
  const std::lock_guard lock(mutex_);
  what_ = std::move(what);
  end_ = end;
}

void ProgressLine::keep_up_to_date() {
  std::unique_lock lock(mutex_);
  const auto is_over = [this] { return is_over_; };
  while (!change_.wait_for(lock, refresh, is_over)) {
    if (stopwatch_.seconds() > patience) draw();
  }
  erase();
}

void ProgressLine::draw() const {
  const double now = stopwatch_.seconds();
  // A guess that has run out says nothing any more.
  const auto left = end_ && *end_ > now ? std::optional(*end_ - now) : std::nullopt;
  erase();
  show(stderr, progress_text(what_, now, left));
}

void ProgressLine::erase() const {
  if (stopwatch_.seconds() > patience) show(stderr, "\r\x1b[K");
}

}  // namespace pleuel
