#pragma once

#include "core/base/task_place.hpp"
#include "core/base/task_work.hpp"

namespace pleuel {

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
