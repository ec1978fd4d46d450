#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/jobs/task_place.hpp"

namespace pleuel {

class RankPlace;  // core/jobs/rank_place.hpp

/// How tasks are carried out. The answers do not depend on it.
struct TaskOptions {
  int jobs = 1;             ///< processes at a time, at least 1
  double time_limit = 0.0;  ///< that a task may take before it is given up [s]; 0: any time
  /// Other ranks of an MPI job, which take tasks that can be packed; none: all run here.
  std::vector<RankPlace>* ranks = nullptr;
};

/// Work in parts that do not see each other: run() of each in a process of its own, which is a copy
/// of this one at that moment, or of another rank that has made the work again; everything else
/// here, in the order of the tasks.
class Tasks : public TaskWork {
 public:
  virtual int count() const = 0;

  /// The task, an earlier one, without whose answer this one cannot begin.
  virtual std::optional<int> needed_by(int /*task*/) const { return std::nullopt; }

  /// For other ranks. Without it all tasks are carried out by this one.
  virtual PackedWork packed_work() const { return {}; }

  /// Answers a question of a task, whenever it comes.
  virtual std::string reply(int /*task*/, const std::string& /*question*/) { return ""; }

  /// Hears what a task tells.
  virtual void hear(int /*task*/, const std::string& /*message*/) {}

  /// Takes the answer of a task.
  virtual void take(int task, const std::string& answer) = 0;

  /// A task that has no answer: its process ended otherwise, or took too long, twice.
  /// @param failure  why: the end of a sentence about it
  virtual void fail(int task, const std::string& failure) = 0;
};

/// Carries out tasks in worker processes, so many at a time here and on each other rank. A worker
/// that crashes or takes too long costs its task only, which is tried once more. What is heard,
/// taken and thrown is the same for any number of jobs and ranks, but for times.
/// @throws Stopped if the end was asked for: workers have ended by then, and what they knew has been
///         heard; answers that were there have been taken, even if earlier tasks have none
/// @throws what the first task threw that did
void run_tasks(Tasks& tasks, const TaskOptions& options);

}  // namespace pleuel
