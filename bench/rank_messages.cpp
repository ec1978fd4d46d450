/// What messages between ranks cost: mpirun -n 2 rank_messages. Prints the wall times of an empty task, of a
/// question that a task asks, and of one of a megabyte, in this process and on another rank.

#include <functional>
#include <memory>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/rank_of_job.hpp"
#include "core/base/packed.hpp"
#include "core/base/stopwatch.hpp"
#include "core/jobs/rank_place.hpp"
#include "core/jobs/task_place.hpp"

namespace pleuel {

namespace {

/// So many questions a task, of so many bytes.
struct Questions : TaskWork {
  int count = 0;
  std::size_t size = 0;

  std::string run(int /*task*/, const std::string& /*needed*/, TaskCaller& caller) override {
    for (int i = 0; i < count; ++i) caller.ask(std::string(size, 'x'));
    return "";
  }
};

std::unique_ptr<TaskWork> make_questions(const std::string& content) {
  auto work = std::make_unique<Questions>();
  unpack(content, work->count, work->size);
  return work;
}

/// Carries out `tasks` at a place, one after the other, and answers what they ask [s].
double seconds_of(TaskPlace& place, int tasks) {
  const Stopwatch stopwatch;
  for (int task = 0; task < tasks; ++task) {
    place.start({task, 1, {}});
    for (bool has_ended = false; !has_ended;) {
      std::vector<pollfd> descriptors;
      place.add_descriptors(descriptors);
      ::poll(descriptors.data(), descriptors.size(), -1);
      for (const TaskEvent& event : place.read(descriptors.data())) {
        has_ended = event.kind == TaskEvent::Kind::ended;
        if (has_ended || event.frame.kind != Frame::Kind::question) continue;
        place.answer(task, event.frame.content);
      }
    }
  }
  return stopwatch.seconds();
}

/// @param of  the place for this work, which outlives it
void measure(const char* where, const std::function<TaskPlace&(Questions&)>& of) {
  constexpr int tasks = 100, questions = 1000, megabytes = 100;
  Questions none, small, large;
  small.count = questions;
  small.size = 100;
  large.count = megabytes;
  large.size = 1'000'000;
  seconds_of(of(none), tasks);  // the first ones fill caches
  const double task = seconds_of(of(none), tasks) / tasks;
  const double question = seconds_of(of(small), 1) / questions;
  const double megabyte = seconds_of(of(large), 1) / megabytes;
  fmt::print("{}: empty task {:.2f} ms, question {:.3f} ms, of a megabyte {:.2f} ms\n", where,
             1e3 * task, 1e3 * question, 1e3 * megabyte);
}

void measure_here() {
  std::unique_ptr<ForkedTasks> here;
  measure("this process", [&](Questions& work) -> TaskPlace& {
    here = std::make_unique<ForkedTasks>(work, 1);
    return *here;
  });
}

void measure_there(Channel link) {
  RankPlace there(std::move(link), "rank 1", 1);
  PackedWork packed_work;
  measure("another rank", [&](Questions& work) -> TaskPlace& {
    packed_work = {"questions", packed(work.count, work.size)};
    there.begin(packed_work);
    return there;
  });
}

}  // namespace

}  // namespace pleuel

int main() {
  using namespace pleuel;
  const auto place = rank_of_job();
  if (!place) {
    measure_here();
    return 0;
  }
  std::vector<Channel> links = join_job(*place);
  if (place->rank > 0) {
    serve_tasks(links.front(), {{"questions", make_questions}});
  } else {
    measure_here();
    measure_there(std::move(links.front()));
  }
}
