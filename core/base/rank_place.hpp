#pragma once

#include <map>
#include <string>

#include "core/base/task_place.hpp"
#include "core/base/task_work.hpp"

namespace pleuel {

/// Another rank of an MPI job, as rank 0 sees it: serve_tasks() is at the other end of the link.
class RankPlace : public TaskPlace {
 public:
  /// @param name     for messages: "rank 2 on node7"
  /// @param workers  tasks at a time
  RankPlace(Channel link, std::string name, int workers)
      : link_(std::move(link)), name_(std::move(name)), workers_(workers) {}

  /// What the next tasks are of. Nothing more is heard of earlier ones, which end.
  /// @param work  outlives the tasks
  void begin(const PackedWork& work);

  int workers() const override { return workers_; }
  void start(const TaskOrder& order) override;
  void answer(int task, const std::string& text) override;
  void kill(int task) override;
  void ask_to_end() override;
  void add_descriptors(std::vector<pollfd>& descriptors) const override;

  /// Where the link is broken, all its tasks have ended, and it has no more workers.
  /// @throws std::runtime_error if it cannot make the work
  std::vector<TaskEvent> read(const pollfd* ready) override;

 private:
  /// Ends of all tasks that run there.
  std::vector<TaskEvent> lose();

  Channel link_;
  std::string name_;
  int workers_;
  const PackedWork* work_ = nullptr;
  bool has_work_ = false;       ///< whether it was sent
  int starts_ = 0;              ///< of all work
  std::map<int, int> running_;  ///< number of the start, by task: tells late events
};

}  // namespace pleuel
