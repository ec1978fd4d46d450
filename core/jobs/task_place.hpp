#pragma once

#include <string>
#include <vector>

#include <poll.h>

#include "core/jobs/worker.hpp"

namespace pleuel {

/// What a task sees of the process that handed it out.
class TaskCaller {
 public:
  virtual ~TaskCaller() = default;

  /// Tasks::hear() hears it when all tasks before this one have ended.
  virtual void tell(const std::string& message) = 0;

  /// What Tasks::reply() says, at once.
  virtual std::string ask(const std::string& question) = 0;
};

/// What is computed in parts that do not see each other.
class TaskWork {
 public:
  virtual ~TaskWork() = default;

  /// In a process of its own. What is thrown here is thrown by run_tasks() if it is an InputError,
  /// a SimulationError, std::bad_alloc or anything else of the standard library (as
  /// std::runtime_error).
  /// @param needed  answer of the task that it needs; empty if that failed, or if it needs none
  /// @returns       the answer; the same in each attempt, as what is told on the way
  virtual std::string run(int task, const std::string& needed, TaskCaller& caller) = 0;
};

/// Work for processes that know nothing of it (core/base/packed.hpp).
struct PackedWork {
  std::string kind;  ///< by which it is made again (rank_place.hpp); empty: it cannot be
  std::string content;
};

/// A task for a worker process.
struct TaskOrder {
  int task = 0;
  int threads = 1;     ///< of its process
  std::string needed;  ///< for Tasks::run()
};

/// What is heard of a worker process.
struct TaskEvent {
  enum class Kind : char { frame, ended };
  Kind kind = Kind::frame;
  int task = 0;
  Frame frame;      ///< that it sent
  std::string how;  ///< it ended, if not in good order: Worker::end()
};

/// Where tasks are carried out: this process and its children, or another rank with its own. A task
/// runs there once at a time.
class TaskPlace {
 public:
  virtual ~TaskPlace() = default;

  /// Tasks that it takes at a time; 0: it is lost.
  virtual int workers() const = 0;

  virtual void start(const TaskOrder& order) = 0;

  /// The answer to a question of a task.
  virtual void answer(int task, const std::string& text) = 0;

  /// Ends a task at once; nothing more is heard of it.
  virtual void kill(int task) = 0;

  /// Asks all tasks to end in good order.
  virtual void ask_to_end() = 0;

  /// Appends what it waits for.
  virtual void add_descriptors(std::vector<pollfd>& descriptors) const = 0;

  /// Reads what has arrived.
  /// @param ready  where its descriptors begin, after a poll
  virtual std::vector<TaskEvent> read(const pollfd* ready) = 0;
};

/// Carries out tasks in processes that are forked from this one, one a task.
class ForkedTasks : public TaskPlace {
 public:
  /// @param work  outlives this
  ForkedTasks(TaskWork& work, int workers) : work_(work), workers_(workers) {}

  int workers() const override { return workers_; }
  void start(const TaskOrder& order) override;
  void answer(int task, const std::string& text) override;
  void kill(int task) override;
  void ask_to_end() override;
  void add_descriptors(std::vector<pollfd>& descriptors) const override;
  std::vector<TaskEvent> read(const pollfd* ready) override;

 private:
  struct Running {
    int task;
    Worker worker;
    bool has_ended = false;
  };

  /// Events of one worker.
  static void read(Running& one, std::vector<TaskEvent>& events);

  TaskWork& work_;
  int workers_;
  std::vector<Running> running_;
};

}  // namespace pleuel
