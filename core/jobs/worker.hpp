#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/types.h>

namespace pleuel {

/// What a worker process sends.
struct Frame {
  enum class Kind : char { message, question, answer, error };
  Kind kind = Kind::message;
  std::string content;
};

/// The two ends of a connection between a process and the one that made it.
class Channel {
 public:
  explicit Channel(int descriptor) : descriptor_(descriptor) {}
  ~Channel();
  Channel(Channel&& other) noexcept;
  Channel& operator=(Channel&& other) noexcept;

  int descriptor() const { return descriptor_; }

  /// @returns whether the other end took it; it may be gone
  bool send(const Frame& frame) const;

  /// Waits for a whole frame. @returns whether there was one
  bool receive(Frame& frame);

  /// What has arrived by now, without waiting for more than the first bytes.
  /// @param frames  whole frames are appended
  /// @returns whether the other end is still there
  bool receive_available(std::vector<Frame>& frames);

 private:
  bool read_some();
  bool take(Frame& frame);

  int descriptor_;
  std::string buffer_;
};

/// There can be no more processes, or connections to them.
class NoWorker : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// As long as there is one, no worker can be made: this process has what a copy of it has no use of, as functions
/// of a program that calls the library.
class WorkersForbidden {
 public:
  WorkersForbidden() noexcept;
  ~WorkersForbidden();
  WorkersForbidden(const WorkersForbidden&) = delete;
  WorkersForbidden& operator=(const WorkersForbidden&) = delete;
};

/// A process that was forked from this one: it has all that is in memory, and shares nothing. It ends
/// with this one, whatever ends that. To be made while no other thread holds anything that the
/// worker needs.
class Worker {
 public:
  /// @param work  runs in the new process, which ends when it returns; nothing may be thrown
  /// @throws NoWorker if the system makes no process, or if workers are forbidden
  explicit Worker(const std::function<void(Channel&)>& work);
  ~Worker();  ///< kills it, if it is still there
  Worker(Worker&& other) noexcept;
  Worker& operator=(Worker&& other) noexcept;

  Channel& channel() { return channel_; }
  const Channel& channel() const { return channel_; }

  /// Asks it to end in good order (SIGTERM).
  void ask_to_end() const;

  /// Ends it at once (SIGKILL).
  void kill() const;

  /// Waits for its end. @returns how it ended if that was not in good order: "signal 11
  /// (Segmentation fault)"
  std::string end();

 private:
  Worker(pid_t process, int descriptor) : process_(process), channel_(descriptor) {}
  static Worker forked(const std::function<void(Channel&)>& work);

  pid_t process_ = -1;
  Channel channel_;
};

/// What a task throws, for the process that handed it out. To be called while it is being handled:
/// InputError, SimulationError, std::bad_alloc, Stopped and everything of the standard library.
std::string thrown_report();

/// Whether it is a Stopped.
bool is_stop(const std::string& report);

/// Throws what was reported: the same type, or std::runtime_error.
[[noreturn]] void throw_again(const std::string& report);

}  // namespace pleuel
