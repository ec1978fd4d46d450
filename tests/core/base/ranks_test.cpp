#include <csignal>
#include <fstream>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "core/jobs/rank_place.hpp"
#include "core/jobs/tasks.hpp"
#include "tests/support/temporary_folder.hpp"

/// Tasks on other ranks, which here are processes of this machine at the other end of a socket.
namespace pleuel::test::ranks_test {
namespace {

using ::testing::HasSubstr;

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
  try {
    run_tasks(tasks, {.jobs = 1, .ranks = servers.places()});
    FAIL() << "nothing was thrown";
  } catch (const SimulationError& error) {
    EXPECT_STREQ(error.what(), "joint 1");
  }
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
}  // namespace pleuel::test::ranks_test
