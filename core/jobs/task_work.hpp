#pragma once

#include <string>

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

}  // namespace pleuel
