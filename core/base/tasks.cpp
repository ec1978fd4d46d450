#include "core/base/tasks.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <exception>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <poll.h>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/stop.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/worker.hpp"

namespace pleuel {

namespace {

constexpr int most_attempts = 2;
constexpr double patience = 0.2;      ///< [s] after which a request to stop is seen
constexpr double time_to_end = 10.0;  ///< [s] for workers that are asked to
enum class Thrown : char { input, simulation, memory, stopped, other };

class Caller : public TaskCaller {
 public:
  explicit Caller(Channel& channel) : channel_(channel) {}

  void tell(const std::string& message) override { send({Frame::Kind::message, message}); }

  std::string ask(const std::string& question) override {
    send({Frame::Kind::question, question});
    Frame reply;
    if (!channel_.receive(reply)) throw Stopped{};
    return std::move(reply.content);
  }

  void answer(const std::string& answer) { send({Frame::Kind::answer, answer}); }

  void report(Thrown kind, const std::string& text) {
    channel_.send({Frame::Kind::error, std::string(1, static_cast<char>(kind)) + text});
  }

 private:
  void send(const Frame& frame) {
    if (!channel_.send(frame)) throw Stopped{};  // there is nobody to work for
  }

  Channel& channel_;
};

/// All that happens in a worker.
void carry_out(Tasks& tasks, int task, const std::string& needed, Channel& channel) {
  Caller caller(channel);
  try {
    caller.answer(tasks.run(task, needed, caller));
  } catch (const InputError& error) {
    caller.report(Thrown::input, error.what());
  } catch (const SimulationError& error) {
    caller.report(Thrown::simulation, error.what());
  } catch (const Stopped&) {
    caller.report(Thrown::stopped, "");
  } catch (const std::bad_alloc&) {
    caller.report(Thrown::memory, "");
  } catch (const std::exception& error) {
    caller.report(Thrown::other, error.what());
  }
}

[[noreturn]] void throw_again(const std::string& report) {
  const std::string text = report.substr(1);
  switch (static_cast<Thrown>(report[0])) {
    case Thrown::input:
      throw InputError(text);
    case Thrown::simulation:
      throw SimulationError(text);
    case Thrown::memory:
      throw std::bad_alloc();
    case Thrown::stopped:
    case Thrown::other:
      break;
  }
  throw std::runtime_error(text);
}

class TaskRun {
 public:
  TaskRun(Tasks& tasks, const TaskOptions& options)
      : tasks_(tasks),
        options_(options),
        states_(static_cast<std::size_t>(tasks.count())),
        threads_(std::max(1, options.jobs / std::clamp(tasks.count(), 1, options.jobs))) {}

  void run() {
    while (delivered_ < states_.size()) {
      try {
        check_stop();
      } catch (const Stopped&) {
        end_workers();
        deliver_rest();
        throw;
      }
      start_workers();
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
    std::vector<std::string> messages;  ///< of the latest attempt
    std::size_t heard = 0;
  };
  using Phase = State::Phase;

  struct Running {
    std::size_t task;
    Worker worker;
    Stopwatch stopwatch;
    bool has_ended = false;
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

  void start_workers() {
    while (running_.size() < static_cast<std::size_t>(std::max(1, options_.jobs))) {
      const auto task = next_task();
      if (!task) return;
      start(*task);
    }
  }

  void start(std::size_t task) {
    State& state = states_[task];
    std::string needed;
    if (const auto index = tasks_.needed_by(static_cast<int>(task))) {
      assert(static_cast<std::size_t>(*index) < task);
      const State& before = states_[*index];
      if (before.phase == Phase::answered) needed = before.result;
    }
    state.phase = Phase::running;
    state.messages.clear();
    ++state.attempts;
    running_.push_back({task, Worker([&](Channel& channel) {
                          limit_threads(threads_);
                          carry_out(tasks_, static_cast<int>(task), needed, channel);
                        }),
                        Stopwatch()});
  }

  /// Waits for news from the workers.
  void listen(double seconds) {
    std::vector<pollfd> descriptors;
    for (Running& one : running_) {
      descriptors.push_back({one.worker.channel().descriptor(), POLLIN, 0});
    }
    if (::poll(descriptors.data(), descriptors.size(), static_cast<int>(1e3 * seconds)) <= 0) {
      return;
    }
    for (std::size_t i = 0; i < descriptors.size(); ++i) {
      if (descriptors[i].revents != 0) read(running_[i]);
    }
    std::erase_if(running_, [](const Running& one) { return one.has_ended; });
  }

  void read(Running& one) {
    std::vector<Frame> frames;
    const bool is_there = one.worker.channel().receive_available(frames);
    State& state = states_[one.task];
    for (Frame& frame : frames) {
      switch (frame.kind) {
        case Frame::Kind::message:
          state.messages.push_back(std::move(frame.content));
          break;
        case Frame::Kind::question:
          one.worker.channel().send(
              {Frame::Kind::answer, tasks_.reply(static_cast<int>(one.task), frame.content)});
          break;
        case Frame::Kind::answer:
          state.phase = Phase::answered;
          state.result = std::move(frame.content);
          break;
        case Frame::Kind::error:
          if (frame.content[0] == static_cast<char>(Thrown::stopped)) break;  // not asked by us
          state.phase = Phase::threw;
          state.result = std::move(frame.content);
          break;
      }
    }
    if (is_there) return;
    const std::string how = one.worker.end();
    one.has_ended = true;
    if (state.phase == Phase::running) {
      try_again(state, how.empty() ? "its process was ended from outside"
                                   : "its process ended with " + how);
    }
  }

  static void try_again(State& state, const std::string& failure) {
    state.phase = state.attempts < most_attempts ? Phase::waiting : Phase::failed;
    state.result = fmt::format("{}, in {} attempts", failure, state.attempts);
  }

  void give_up_slow_ones() {
    if (options_.time_limit <= 0.0) return;
    std::erase_if(running_, [&](Running& one) {
      if (one.stopwatch.seconds() <= options_.time_limit) return false;
      one.worker.kill();
      one.worker.end();
      try_again(states_[one.task], fmt::format("it took longer than the {:g} s that it may take",
                                               options_.time_limit));
      return true;
    });
  }

  void hear(std::size_t task) {
    State& state = states_[task];
    // A second attempt tells the same as the first did.
    for (; state.heard < state.messages.size(); ++state.heard) {
      tasks_.hear(static_cast<int>(task), state.messages[state.heard]);
      state.messages[state.heard].clear();
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
        throw_again(state.result);
      } else {
        return;
      }
    }
  }

  /// After a request to stop: in good order if they can.
  void end_workers() {
    const Stopwatch stopwatch;
    for (Running& one : running_) one.worker.ask_to_end();
    while (!running_.empty() && stopwatch.seconds() < time_to_end) listen(patience);
    running_.clear();
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
  std::vector<State> states_;
  std::vector<Running> running_;
  std::size_t delivered_ = 0;  ///< so many tasks have ended for those who listen
  int threads_;                ///< of each worker
};

}  // namespace

void run_tasks(Tasks& tasks, const TaskOptions& options) {
  TaskRun(tasks, options).run();
}

}  // namespace pleuel
