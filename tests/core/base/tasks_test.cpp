#include "core/jobs/tasks.hpp"

#include <atomic>
#include <csignal>
#include <fstream>
#include <functional>
#include <memory>
#include <stdexcept>

#include <sys/resource.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "core/base/stopwatch.hpp"
#include "core/jobs/parallel.hpp"
#include "core/jobs/rank_place.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::tasks_test {
namespace {

/// Tasks that are one function, and what was heard of them.
class Noted : public Tasks {
 public:
  using Run = std::function<std::string(int, const std::string&, TaskCaller&)>;
  Noted(int count, Run run) : count_(count), run_(std::move(run)) {}

  int count() const override { return count_; }
  std::optional<int> needed_by(int task) const override {
    return is_chain && task > 0 ? std::optional(task / 2) : std::nullopt;
  }
  std::string run(int task, const std::string& needed, TaskCaller& caller) override {
    return run_(task, needed, caller);
  }
  std::string reply(int task, const std::string& question) override {
    ++replies;
    return fmt::format("{}{}", question, task);
  }
  void hear(int task, const std::string& message) override {
    notes.push_back(fmt::format("{}: {}", task, message));
  }
  void take(int task, const std::string& answer) override {
    notes.push_back(fmt::format("{} = {}", task, answer));
  }
  void fail(int task, const std::string& failure) override {
    notes.push_back(fmt::format("{} failed: {}", task, failure));
  }

  bool is_chain = false;
  int replies = 0;
  std::vector<std::string> notes;

 private:
  int count_;
  Run run_;
};

/// How often something happened, over all processes.
class Tally {
 public:
  int add() const {
    std::ofstream(path(), std::ios::app) << 'x';
    return count();
  }
  int count() const {
    std::ifstream stream(path());
    return static_cast<int>(std::string(std::istreambuf_iterator<char>(stream), {}).size());
  }

 private:
  std::filesystem::path path() const { return folder_.path() / "tally"; }
  TemporaryFolder folder_;
};

std::vector<std::string> notes_with(int jobs, const std::function<void(Noted&)>& prepare = {}) {
  Noted tasks(5, [](int task, const std::string& needed, TaskCaller& caller) {
    ::usleep(static_cast<useconds_t>(4000 * (5 - task)));  // later ones end first
    caller.tell("begun with " + needed);
    caller.tell(caller.ask("asked "));
    return fmt::format("{}", task * task);
  });
  if (prepare) prepare(tasks);
  run_tasks(tasks, {.jobs = jobs});
  return tasks.notes;
}

TEST(Tasks, AreHeardInTheirOrderForAnyNumberOfJobs) {
  const std::vector<std::string> one = notes_with(1);
  ASSERT_EQ(one.size(), 15u);
  EXPECT_EQ(one[3], "1: begun with ");
  EXPECT_EQ(one[4], "1: asked 1");
  EXPECT_EQ(one[5], "1 = 1");
  for (const int jobs : {2, 3, 8}) EXPECT_EQ(notes_with(jobs), one) << jobs;
}

TEST(Tasks, BeginWithTheAnswerThatTheyNeed) {
  const auto chain = [](Noted& tasks) { tasks.is_chain = true; };
  const std::vector<std::string> one = notes_with(1, chain);
  EXPECT_EQ(one[12], "4: begun with 4");  // 4 needs 2
  for (const int jobs : {2, 3, 8}) EXPECT_EQ(notes_with(jobs, chain), one) << jobs;
}

/// So many descriptors may be open in a block.
class DescriptorLimit {
 public:
  explicit DescriptorLimit(rlim_t most) {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit limit = {most, before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &limit);
  }
  ~DescriptorLimit() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  DescriptorLimit(const DescriptorLimit&) = delete;
  DescriptorLimit& operator=(const DescriptorLimit&) = delete;

 private:
  rlimit before_ = {};
};

TEST(Tasks, AreTheSameWhereThereCanBeFewerWorkersOrNone) {
  const std::vector<std::string> one = notes_with(1);
  const int next = ::dup(STDIN_FILENO);
  ::close(next);
  for (int more = 0; more < 5; ++more) {
    const DescriptorLimit limit(static_cast<rlim_t>(next + more));
    EXPECT_EQ(notes_with(4), one) << more;
  }
}

TEST(Tasks, PassOnWhatTheyThrowWithoutWorkers) {
  Noted tasks(2, [](int, const std::string&, TaskCaller&) -> std::string {
    throw InputError("a bad number");
  });
  const DescriptorLimit limit(0);
  EXPECT_THROW(run_tasks(tasks, {.jobs = 2}), InputError);
}

TEST(Tasks, RunInProcessesOfTheirOwn) {
  int changed = 0;
  Noted tasks(2, [&](int, const std::string&, TaskCaller&) {
    ++changed;
    return std::string(::getpid() == ::getppid() ? "same" : "other");
  });
  run_tasks(tasks, {.jobs = 1});
  EXPECT_EQ(changed, 0);
}

TEST(Tasks, WhoseProcessIsKilledAreTriedOnceMoreAndHeardOnce) {
  for (const int jobs : {1, 2}) {
    const Tally tally;
    Noted tasks(3, [&](int task, const std::string&, TaskCaller& caller) {
      caller.tell("begun");
      if (task == 1 && tally.add() == 1) ::kill(::getpid(), SIGKILL);
      return std::string("done");
    });
    run_tasks(tasks, {.jobs = jobs});
    EXPECT_EQ(tally.count(), 2);
    EXPECT_THAT(tasks.notes, ElementsAre("0: begun", "0 = done", "1: begun", "1 = done", "2: begun",
                                         "2 = done"));
  }
}

TEST(Tasks, ThatCrashTwiceFailWithTheSignalAndTheRestGoesOn) {
  Noted tasks(3, [](int task, const std::string&, TaskCaller&) {
    if (task == 0) std::raise(SIGKILL);
    return std::string("done");
  });
  run_tasks(tasks, {.jobs = 2});
  ASSERT_EQ(tasks.notes.size(), 3u);
  EXPECT_THAT(tasks.notes[0], HasSubstr("0 failed: its process ended with signal 9"));
  EXPECT_THAT(tasks.notes[0], HasSubstr("in 2 attempts"));
  EXPECT_EQ(tasks.notes[2], "2 = done");
}

TEST(Tasks, ThatHangAreGivenUpAfterTheirTime) {
  const Stopwatch stopwatch;
  Noted tasks(2, [](int task, const std::string&, TaskCaller&) {
    if (task == 0) ::sleep(100);
    return std::string("done");
  });
  run_tasks(tasks, {.jobs = 2, .time_limit = 0.3});
  EXPECT_THAT(tasks.notes[0], HasSubstr("took longer than the 0.3 s"));
  EXPECT_EQ(tasks.notes[1], "1 = done");
  EXPECT_LT(stopwatch.seconds(), 20.0);
}

/// An answer counts, though the process that gave it lives on beyond the time for it (here by a
/// child of its own).
TEST(Tasks, ThatHaveAnsweredAreNotGivenUp) {
  Noted tasks(2, [](int task, const std::string& needed, TaskCaller&) {
    if (task == 0 && ::fork() == 0) {
      ::sleep(1);
      ::_exit(0);
    }
    return "done" + needed;
  });
  tasks.is_chain = true;
  run_tasks(tasks, {.jobs = 1, .time_limit = 0.3});
  EXPECT_THAT(tasks.notes, ElementsAre("0 = done", "1 = donedone"));
}

/// Of several, what the first one throws, after what the ones before it have told.
TEST(Tasks, PassOnWhatTheyThrow) {
  for (const int jobs : {1, 2, 4}) {
    Noted tasks(4, [](int task, const std::string&, TaskCaller&) -> std::string {
      if (task == 1) {
        ::usleep(20000);
        throw SimulationError("joint");
      }
      if (task > 1) throw InputError("/file");
      return "done";
    });
    EXPECT_THROW(run_tasks(tasks, {.jobs = jobs}), SimulationError);
    EXPECT_THAT(tasks.notes, ElementsAre("0 = done"));
  }
}

TEST(Tasks, CarryMegabytes) {
  const std::string large(3'000'000, 'z');
  Noted tasks(1, [&](int, const std::string&, TaskCaller& caller) {
    return caller.ask(large) == large + "0" ? large : std::string();
  });
  run_tasks(tasks, {.jobs = 1});
  EXPECT_EQ(tasks.notes, (std::vector<std::string>{"0 = " + large}));
}

TEST(Tasks, MayBeNone) {
  Noted tasks(0, [](int, const std::string&, TaskCaller&) { return std::string(); });
  run_tasks(tasks, {.jobs = 2});
  EXPECT_TRUE(tasks.notes.empty());
}

TEST(ParallelWork, IsDoneOnceEach) {
  for (int threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> calls(50);
    for_each_in_parallel(50, threads, [&](int i) { ++calls[i]; });
    for (const auto& count : calls) EXPECT_EQ(count, 1);
  }
}

TEST(ParallelWork, PassesOnTheFirstFailure) {
  for (int threads : {1, 4}) {
    const auto fail = [](int i) {
      if (i >= 3) throw std::runtime_error(std::to_string(i));
    };
    EXPECT_EQ(thrown<std::runtime_error>([&] { for_each_in_parallel(20, threads, fail); }), "3");
  }
}

TEST(ParallelWork, MayBeNone) {
  for_each_in_parallel(0, 4, [](int) { FAIL(); });
}

// Tasks on other ranks, which here are processes of this machine at the other end of a socket.

/// What a task does, by its kind of work.
struct RankWork : TaskWork {
  explicit RankWork(std::string kind, std::string file = "")
      : kind_(std::move(kind)), file_(std::move(file)) {}

  std::string run(int task, const std::string& needed, TaskCaller& caller) override {
    if (kind_ == "dies" && task == 1) ::kill(::getpid(), SIGKILL);
    if (kind_ == "dies once" && task == 1 && is_first()) ::kill(::getpid(), SIGKILL);
    if (kind_ == "throws" && task >= 1) throw SimulationError(fmt::format("joint {}", task));
    if (kind_ == "hangs" && task == 1) ::sleep(100);
    if (kind_ == "says who") return std::to_string(::getppid());
    if (kind_ == "loses its rank" && task == 1 && is_first()) ::kill(::getppid(), SIGKILL);
    if (kind_ == "is large") return caller.ask(std::string(3'000'000, 'z'));
    ::usleep(static_cast<useconds_t>(3000 * (5 - task)));  // later ones end first
    caller.tell("begun with " + needed);
    return caller.ask("asked ") + fmt::format(" {}", task * task);
  }

 private:
  bool is_first() const {
    const bool is_there = std::ifstream(file_).good();
    std::ofstream(file_) << "x";
    return !is_there;
  }

  std::string kind_, file_;
};

std::unique_ptr<TaskWork> make_work(const std::string& content) {
  const std::size_t end = content.find('|');
  return std::make_unique<RankWork>(content.substr(0, end), content.substr(end + 1));
}

class NotedWork : public Tasks {
 public:
  NotedWork(int count, const std::string& kind)
      : count_(count),
        kind_(kind),
        file_((folder_.path() / "first").string()),
        work_(kind, file_) {}

  int count() const override { return count_; }
  std::optional<int> needed_by(int task) const override {
    return kind_ == "chain" && task > 0 ? std::optional(task / 2) : std::nullopt;
  }
  PackedWork packed_work() const override { return {"work", kind_ + "|" + file_}; }
  std::string run(int task, const std::string& needed, TaskCaller& caller) override {
    return work_.run(task, needed, caller);
  }
  std::string reply(int task, const std::string& question) override {
    return fmt::format("{}{}", question, task);
  }
  void hear(int task, const std::string& message) override {
    notes.push_back(fmt::format("{}: {}", task, message));
  }
  void take(int task, const std::string& answer) override {
    notes.push_back(fmt::format("{} = {}", task, answer));
  }
  void fail(int task, const std::string& failure) override {
    notes.push_back(fmt::format("{} failed: {}", task, failure));
  }

  std::vector<std::string> notes;

 private:
  int count_;
  std::string kind_;
  TemporaryFolder folder_;
  std::string file_;
  RankWork work_;
};

/// So many ranks besides this process.
class Servers {
 public:
  explicit Servers(int count, int workers = 1) {
    const auto serve = [](Channel& link) { serve_tasks(link, {{"work", make_work}}); };
    for (int i = 0; i < count; ++i) {
      processes_.emplace_back(serve);
      places_.emplace_back(std::move(processes_.back().channel()), fmt::format("rank {}", i + 1),
                           workers);
    }
  }
  std::vector<RankPlace>* places() { return &places_; }

 private:
  std::vector<Worker> processes_;
  std::vector<RankPlace> places_;
};

std::vector<std::string> notes_of(const std::string& kind, int ranks, double time_limit = 0.0) {
  Servers servers(ranks - 1);
  NotedWork tasks(5, kind);
  run_tasks(tasks, {.jobs = 1, .time_limit = time_limit, .ranks = servers.places()});
  return tasks.notes;
}

TEST(Ranks, DoNotChangeWhatIsHeard) {
  for (const char* kind : {"plain", "chain"}) {
    const std::vector<std::string> one = notes_of(kind, 1);
    ASSERT_EQ(one.size(), 10u);
    EXPECT_EQ(one[3], "1 = asked 1 1");
    for (const int ranks : {2, 3, 4}) EXPECT_EQ(notes_of(kind, ranks), one) << ranks;
  }
}

TEST(Ranks, TakeTheirPartOfTheTasks) {
  const std::vector<std::string> notes = notes_of("says who", 2);
  EXPECT_NE(notes[0].substr(4), notes[1].substr(4));
  EXPECT_EQ(notes[0].substr(4), std::to_string(::getpid()));
}

TEST(Ranks, MayLoseAWorkerWhichIsTriedOnceMore) {
  EXPECT_EQ(notes_of("dies once", 2), notes_of("plain", 1));
}

TEST(Ranks, MayBeLost) {
  EXPECT_EQ(notes_of("loses its rank", 2), notes_of("plain", 1));
}

TEST(Ranks, TellWhyATaskFailed) {
  const std::vector<std::string> notes = notes_of("dies", 3);
  EXPECT_THAT(notes, testing::Contains(HasSubstr("1 failed: its process ended with signal 9")));
  EXPECT_EQ(notes.size(), 9u);
}

TEST(Ranks, GiveUpTasksThatHang) {
  const std::vector<std::string> notes = notes_of("hangs", 2, 0.3);
  EXPECT_THAT(notes, testing::Contains(HasSubstr("took longer than the 0.3 s")));
  EXPECT_EQ(notes.size(), 9u);
}

TEST(Ranks, PassOnWhatTasksThrow) {
  Servers servers(2);
  NotedWork tasks(5, "throws");
  EXPECT_EQ(
      thrown<SimulationError>([&] { run_tasks(tasks, {.jobs = 1, .ranks = servers.places()}); }),
      "joint 1")
      << "nothing was thrown";
  // And they take other work then.
  NotedWork others(5, "plain");
  run_tasks(others, {.jobs = 1, .ranks = servers.places()});
  EXPECT_EQ(others.notes, notes_of("plain", 1));
}

TEST(Ranks, CarryMegabytes) {
  for (const std::string& note : notes_of("is large", 3)) EXPECT_EQ(note.size(), 3'000'005u);
}

TEST(Ranks, ThatCannotMakeTheWorkSaySo) {
  Servers servers(1);
  class Unknown : public NotedWork {
   public:
    Unknown() : NotedWork(5, "plain") {}
    PackedWork packed_work() const override { return {"unknown", ""}; }
  } tasks;
  EXPECT_THROW(run_tasks(tasks, {.jobs = 1, .ranks = servers.places()}), std::runtime_error);
}

}  // namespace
}  // namespace pleuel::test::tasks_test
