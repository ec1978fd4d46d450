#include "core/jobs/task_place.hpp"

#include <utility>

#include "core/base/stop.hpp"
#include "core/jobs/parallel.hpp"

namespace pleuel {

namespace {

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

  void report(const std::string& thrown) { channel_.send({Frame::Kind::error, thrown}); }

 private:
  void send(const Frame& frame) {
    if (!channel_.send(frame)) throw Stopped{};  // there is nobody to work for
  }

  Channel& channel_;
};

/// All that happens in a worker.
void carry_out(TaskWork& work, const TaskOrder& order, Channel& channel) {
  Caller caller(channel);
  try {
    limit_threads(order.threads);
    caller.answer(work.run(order.task, order.needed, caller));
  } catch (...) {
    caller.report(thrown_report());
  }
}

}  // namespace

void ForkedTasks::start(const TaskOrder& order) {
  running_.push_back(
      {order.task, Worker([&](Channel& channel) { carry_out(work_, order, channel); })});
}

void ForkedTasks::answer(int task, const std::string& text) {
  for (Running& one : running_) {
    if (one.task == task) one.worker.channel().send({Frame::Kind::answer, text});
  }
}

void ForkedTasks::kill(int task) {
  std::erase_if(running_, [&](const Running& one) { return one.task == task; });
}

void ForkedTasks::ask_to_end() {
  for (const Running& one : running_) one.worker.ask_to_end();
}

void ForkedTasks::add_descriptors(std::vector<pollfd>& descriptors) const {
  for (const Running& one : running_) {
    descriptors.push_back({one.worker.channel().descriptor(), POLLIN, 0});
  }
}

std::vector<TaskEvent> ForkedTasks::read(const pollfd* ready) {
  std::vector<TaskEvent> events;
  for (std::size_t i = 0; i < running_.size(); ++i) {
    if (ready[i].revents != 0) read(running_[i], events);
  }
  std::erase_if(running_, [](const Running& one) { return one.has_ended; });
  return events;
}

void ForkedTasks::read(Running& one, std::vector<TaskEvent>& events) {
  std::vector<Frame> frames;
  const bool is_there = one.worker.channel().receive_available(frames);
  for (Frame& frame : frames) {
    events.push_back({TaskEvent::Kind::frame, one.task, std::move(frame), {}});
  }
  if (is_there) return;
  events.push_back({TaskEvent::Kind::ended, one.task, {}, one.worker.end()});
  one.has_ended = true;
}

}  // namespace pleuel
