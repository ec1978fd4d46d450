#include "core/base/rank_place.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/base/rank_messages.hpp"

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

}  // namespace pleuel
