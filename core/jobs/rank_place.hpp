#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "core/base/packed.hpp"
#include "core/jobs/task_place.hpp"
#include "core/jobs/worker.hpp"

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

// What a process and the ranks that work for it say to each other: packed, one message a frame.

/// Followed by PackedWork; number and order; task and text; task; nothing.
enum class ToRank : char { work, start, answer, kill, ask_to_end };

/// Followed by number and event; what went wrong.
enum class FromRank : char { event, problem };

template <class... Values>
Frame message_of(const Values&... values) {
  return {Frame::Kind::message, packed(values...)};
}

/// Makes work again from its PackedWork, by kind.
using WorkMakers =
    std::map<std::string, std::function<std::unique_ptr<TaskWork>(const std::string& content)>>;

/// Carries out tasks of another rank (rank_place.hpp), each in a process forked from this one, until
/// the other end of the link is closed.
void serve_tasks(Channel& link, const WorkMakers& makers);

}  // namespace pleuel
