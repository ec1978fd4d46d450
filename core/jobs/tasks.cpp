#include "core/jobs/tasks.hpp"

#include <algorithm>
#include <cassert>
#include <exception>
#include <functional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <poll.h>

#include "core/base/stop.hpp"
#include "core/base/stopwatch.hpp"
#include "core/jobs/rank_place.hpp"
#include "core/jobs/task_place.hpp"
#include "core/jobs/worker.hpp"

namespace pleuel {

namespace {

constexpr int most_attempts = 2;
constexpr double patience = 0.2;      ///< [s] after which a request to stop is seen
constexpr double time_to_end = 10.0;  ///< [s] for workers that are asked to

/// Where tasks can be carried out.
class TaskPlaces {
 public:
  TaskPlaces(Tasks& tasks, const TaskOptions& options)
      : here_(tasks, std::max(1, options.jobs)), work_(tasks.packed_work()), all_{&here_} {
    if (work_.kind.empty() || options.ranks == nullptr) return;
    for (RankPlace& rank : *options.ranks) {
      rank.begin(work_);
      all_.push_back(&rank);
    }
  }

  const std::vector<TaskPlace*>& all() const { return all_; }

  int workers() const {
    int sum = 0;
    for (const TaskPlace* place : all_) sum += place->workers();
    return sum;
  }

 private:
  ForkedTasks here_;
  PackedWork work_;
  std::vector<TaskPlace*> all_;  ///< this process first
};

/// For a task that this process carries out itself.
class CallerHere : public TaskCaller {
 public:
  using Told = std::function<void(const std::string& message)>;

  CallerHere(Tasks& tasks, int task, Told told)
      : tasks_(tasks), task_(task), told_(std::move(told)) {}

  void tell(const std::string& message) override { told_(message); }
  std::string ask(const std::string& question) override { return tasks_.reply(task_, question); }

 private:
  Tasks& tasks_;
  int task_;
  Told told_;
};

class TaskRun {
 public:
  TaskRun(Tasks& tasks, const TaskOptions& options)
      : tasks_(tasks), options_(options), places_(tasks, options), states_(tasks.count()) {}

  ~TaskRun() {
    for (const Running& one : running_) one.place->kill(static_cast<int>(one.task));
  }
  TaskRun(const TaskRun&) = delete;
  TaskRun& operator=(const TaskRun&) = delete;

  void run() {
    while (delivered_ < states_.size()) {
      try {
        check_stop();
        start_workers();
      } catch (const Stopped&) {
        end_workers();
        deliver_rest();
        throw;
      }
      listen(patience);
      give_up_slow_ones();
      deliver();
    }
  }

 private:
  struct State {
    enum class Phase { waiting, running, answered, threw, failed };
    Phase phase = Phase::waiting;
    int attempts = 0;
    std::string result;                 ///< answer, what was thrown, or why it failed
    std::exception_ptr thrown;          ///< here
    std::vector<std::string> messages;  ///< of the latest attempt
    std::size_t heard = 0;
  };
  using Phase = State::Phase;

  struct Running {
    std::size_t task;
    TaskPlace* place;
    Stopwatch stopwatch;
  };

  static bool has_ended(const State& state) {
    return state.phase != Phase::waiting && state.phase != Phase::running;
  }

  /// The first one that can begin. Nothing begins behind a task that threw.
  std::optional<std::size_t> next_task() const {
    for (std::size_t i = delivered_; i < states_.size(); ++i) {
      if (states_[i].phase == Phase::threw) return std::nullopt;
      if (states_[i].phase != Phase::waiting) continue;
      const auto needed = tasks_.needed_by(static_cast<int>(i));
      if (!needed || has_ended(states_[*needed])) return i;
    }
    return std::nullopt;
  }

  int free_workers(const TaskPlace* place) const {
    const auto busy =
        std::ranges::count_if(running_, [&](const Running& one) { return one.place == place; });
    return place->workers() - static_cast<int>(busy);
  }

  /// The one with most of its workers free, if any has one.
  TaskPlace* free_place() const {
    TaskPlace* best =
        *std::ranges::max_element(places_.all(), [&](const TaskPlace* one, const TaskPlace* other) {
          return free_workers(one) < free_workers(other);
        });
    return free_workers(best) > 0 ? best : nullptr;
  }

  void start_workers() {
    while (TaskPlace* place = free_place()) {
      const auto task = next_task();
      if (!task || !start(*task, *place)) return;
    }
  }

  /// Of each worker, where there are fewer tasks than workers.
  int threads() const {
    const int workers = places_.workers();
    return workers / std::clamp(tasks_.count(), 1, workers);
  }

  /// @returns whether it has begun: where there can be no more workers, those that are there go on,
  /// and without any this process does what a worker would
  bool start(std::size_t task, TaskPlace& place) {
    State& state = states_[task];
    TaskOrder order = {static_cast<int>(task), std::min(threads(), place.workers()), {}};
    if (const auto index = tasks_.needed_by(order.task)) {
      assert(static_cast<std::size_t>(*index) < task);
      const State& before = states_[*index];
      if (before.phase == Phase::answered) order.needed = before.result;
    }
    state.phase = Phase::running;
    state.messages.clear();
    ++state.attempts;
    running_.push_back({task, &place, Stopwatch()});
    try {
      place.start(order);
      return true;
    } catch (const NoWorker&) {
      running_.pop_back();
      --state.attempts;
      state.phase = Phase::waiting;
      if (running_.empty()) carry_out_here(order, state);
      return false;
    }
  }

  /// Nothing runs: all before it is delivered, and who listens hears of it meanwhile.
  void carry_out_here(const TaskOrder& order, State& state) {
    deliver();
    CallerHere caller(tasks_, order.task, [&](const std::string& message) {
      state.messages.push_back(message);
      if (delivered_ == static_cast<std::size_t>(order.task)) hear(delivered_);
    });
    try {
      state.result = tasks_.run(order.task, order.needed, caller);
      state.phase = Phase::answered;
    } catch (const Stopped&) {
      throw;
    } catch (...) {
      state.thrown = std::current_exception();
      state.phase = Phase::threw;
    }
  }

  /// Waits for news from the workers.
  void listen(double seconds) {
    if (running_.empty()) return;
    std::vector<pollfd> descriptors;
    std::vector<std::size_t> begins;
    for (const TaskPlace* place : places_.all()) {
      begins.push_back(descriptors.size());
      place->add_descriptors(descriptors);
    }
    if (::poll(descriptors.data(), descriptors.size(), static_cast<int>(1e3 * seconds)) <= 0) {
      return;
    }
    for (std::size_t i = 0; i < begins.size(); ++i) {
      TaskPlace& place = *places_.all()[i];
      for (TaskEvent& event : place.read(descriptors.data() + begins[i])) see(event, place);
    }
  }

  void see(TaskEvent& event, TaskPlace& place) {
    State& state = states_[event.task];
    if (event.kind == TaskEvent::Kind::ended) {
      std::erase_if(running_, [&](const Running& one) {
        return one.task == static_cast<std::size_t>(event.task);
      });
      if (state.phase != Phase::running) return;
      try_again(state, event.how.empty() ? "its process was ended from outside"
                                         : "its process ended with " + event.how);
      return;
    }
    Frame& frame = event.frame;
    switch (frame.kind) {
      case Frame::Kind::message:
        state.messages.push_back(std::move(frame.content));
        break;
      case Frame::Kind::question:
        place.answer(event.task, tasks_.reply(event.task, frame.content));
        break;
      case Frame::Kind::answer:
        state.phase = Phase::answered;
        state.result = std::move(frame.content);
        break;
      case Frame::Kind::error:
        if (is_stop(frame.content)) break;  // not asked by us
        state.phase = Phase::threw;
        state.result = std::move(frame.content);
        break;
    }
  }

  static void try_again(State& state, const std::string& failure) {
    state.phase = state.attempts < most_attempts ? Phase::waiting : Phase::failed;
    state.result = fmt::format("{}, in {} attempts", failure, state.attempts);
  }

  void give_up_slow_ones() {
    if (options_.time_limit <= 0.0) return;
    std::erase_if(running_, [&](Running& one) {
      if (has_ended(states_[one.task])) return false;  // its answer is here, its process will end
      if (one.stopwatch.seconds() <= options_.time_limit) return false;
      one.place->kill(static_cast<int>(one.task));
      try_again(states_[one.task], fmt::format("it took longer than the {:g} s that it may take",
                                               options_.time_limit));
      return true;
    });
  }

  void hear(std::size_t task) {
    State& state = states_[task];
    // A second attempt tells the same as the first did.
    while (state.heard < state.messages.size()) {
      const std::string message = std::move(state.messages[state.heard++]);
      tasks_.hear(static_cast<int>(task), message);
    }
  }

  void deliver() {
    for (; delivered_ < states_.size(); ++delivered_) {
      const int task = static_cast<int>(delivered_);
      const State& state = states_[delivered_];
      hear(delivered_);
      if (state.phase == Phase::answered) {
        tasks_.take(task, state.result);
      } else if (state.phase == Phase::failed) {
        tasks_.fail(task, state.result);
      } else if (state.phase == Phase::threw) {
        if (state.thrown) std::rethrow_exception(state.thrown);
        throw_again(state.result);
      } else {
        return;
      }
    }
  }

  /// After a request to stop: in good order if they can.
  void end_workers() {
    const Stopwatch stopwatch;
    for (TaskPlace* place : places_.all()) place->ask_to_end();
    while (!running_.empty() && stopwatch.seconds() < time_to_end) listen(patience);
  }

  void deliver_rest() {
    for (; delivered_ < states_.size(); ++delivered_) {
      hear(delivered_);
      const State& state = states_[delivered_];
      if (state.phase == Phase::answered) {
        tasks_.take(static_cast<int>(delivered_), state.result);
      }
    }
  }

  Tasks& tasks_;
  const TaskOptions& options_;
  TaskPlaces places_;
  std::vector<State> states_;
  std::vector<Running> running_;
  std::size_t delivered_ = 0;  ///< so many tasks have ended for those who listen
};

}  // namespace

void run_tasks(Tasks& tasks, const TaskOptions& options) {
  TaskRun(tasks, options).run();
}

}  // namespace pleuel
