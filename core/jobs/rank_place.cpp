#include "core/jobs/rank_place.hpp"

#include <cerrno>
#include <exception>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/jobs/task_place.hpp"

namespace pleuel {

void RankPlace::begin(const PackedWork& work) {
  work_ = &work;
  has_work_ = false;
  running_.clear();
}

void RankPlace::start(const TaskOrder& order) {
  if (!std::exchange(has_work_, true)) link_.send(message_of(ToRank::work, *work_));
  running_[order.task] = ++starts_;
  link_.send(message_of(ToRank::start, starts_, order));  // if it is gone, read() tells
}

void RankPlace::answer(int task, const std::string& text) {
  link_.send(message_of(ToRank::answer, task, text));
}

void RankPlace::kill(int task) {
  running_.erase(task);
  link_.send(message_of(ToRank::kill, task));
}

void RankPlace::ask_to_end() {
  link_.send(message_of(ToRank::ask_to_end));
}

void RankPlace::add_descriptors(std::vector<pollfd>& descriptors) const {
  if (workers_ > 0) descriptors.push_back({link_.descriptor(), POLLIN, 0});
}

std::vector<TaskEvent> RankPlace::read(const pollfd* ready) {
  if (workers_ == 0 || ready->revents == 0) return {};
  std::vector<Frame> frames;
  const bool is_there = link_.receive_available(frames);
  std::vector<TaskEvent> events;
  for (const Frame& frame : frames) {
    Unpacker unpacker(frame.content);
    FromRank kind = FromRank::event;
    unpacker(kind);
    if (kind == FromRank::problem) {
      std::string text;
      unpacker(text);
      throw std::runtime_error(fmt::format("{}: {}", name_, text));
    }
    int number = 0;
    TaskEvent event;
    unpacker(number, event);
    const auto started = running_.find(event.task);
    if (started == running_.end() || started->second != number) continue;
    if (event.kind == TaskEvent::Kind::ended) running_.erase(started);
    events.push_back(std::move(event));
  }
  if (is_there) return events;
  for (TaskEvent& end : lose()) events.push_back(std::move(end));
  return events;
}

std::vector<TaskEvent> RankPlace::lose() {
  std::vector<TaskEvent> events;
  for (const auto& [task, number] : running_) {
    events.push_back({TaskEvent::Kind::ended, task, {}, fmt::format("{}, which was lost", name_)});
  }
  running_.clear();
  workers_ = 0;
  return events;
}

namespace {

class TaskServer {
 public:
  TaskServer(Channel& link, const WorkMakers& makers) : link_(link), makers_(makers) {}

  void run() {
    while (is_there_) {
      std::vector<pollfd> descriptors = {{link_.descriptor(), POLLIN, 0}};
      if (place_) place_->add_descriptors(descriptors);
      if (::poll(descriptors.data(), descriptors.size(), -1) == -1 && errno != EINTR) return;
      if (place_) pass_on(place_->read(descriptors.data() + 1));
      if (descriptors.front().revents != 0) read_link();
    }
  }

 private:
  void read_link() {
    std::vector<Frame> frames;
    is_there_ = link_.receive_available(frames);
    for (const Frame& frame : frames) {
      try {
        obey(frame.content);
      } catch (const std::exception& error) {
        link_.send(message_of(FromRank::problem, std::string(error.what())));
      }
    }
  }

  void obey(const std::string& message) {
    Unpacker unpacker(message);
    ToRank kind = ToRank::work;
    int task = 0;
    std::string text;
    unpacker(kind);
    switch (kind) {
      case ToRank::work:
        take_work(unpacker);
        break;
      case ToRank::start:
        start(unpacker);
        break;
      case ToRank::answer:
        unpacker(task, text);
        place_.value().answer(task, text);
        break;
      case ToRank::kill:
        unpacker(task);
        place_.value().kill(task);
        break;
      case ToRank::ask_to_end:
        if (place_) place_->ask_to_end();
        break;
    }
  }

  void take_work(Unpacker& unpacker) {
    PackedWork packed_work;
    unpacker(packed_work);
    place_.reset();
    const auto maker = makers_.find(packed_work.kind);
    if (maker == makers_.end()) {
      throw std::runtime_error(fmt::format("there is no work \"{}\"", packed_work.kind));
    }
    work_ = maker->second(packed_work.content);
    place_.emplace(*work_, std::numeric_limits<int>::max());  // whoever asks knows how many
  }

  void start(Unpacker& unpacker) {
    int number = 0;
    TaskOrder order;
    unpacker(number, order);
    numbers_[order.task] = number;
    place_.value().start(order);
  }

  void pass_on(const std::vector<TaskEvent>& events) {
    for (const TaskEvent& event : events) {
      link_.send(message_of(FromRank::event, numbers_.at(event.task), event));
    }
  }

  Channel& link_;
  const WorkMakers& makers_;
  std::unique_ptr<TaskWork> work_;
  std::optional<ForkedTasks> place_;  ///< where the work is carried out
  std::map<int, int> numbers_;        ///< of the latest starts, by task
  bool is_there_ = true;
};

}  // namespace

void serve_tasks(Channel& link, const WorkMakers& makers) {
  TaskServer(link, makers).run();
}

}  // namespace pleuel
