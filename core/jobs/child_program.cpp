#include "core/jobs/child_program.hpp"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "core/base/stop.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;

std::atomic<int> permissions = 0;

constexpr int could_not_start = 127;  // as shells have it

/// What goes in and comes out, as files: no pipe that fills up while nobody reads.
class Streams {
 public:
  explicit Streams(const std::string& input) {
    std::string name = (fs::temp_directory_path() / "pleuel-program-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw SimulationError(fmt::format("{}: no folder can be made for what programs write", name));
    }
    folder_ = name;
    std::ofstream(in(), std::ios::binary) << input;
  }
  ~Streams() {
    std::error_code error;
    fs::remove_all(folder_, error);
  }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;

  std::string in() const { return folder_ / "in"; }
  std::string out() const { return folder_ / "out"; }
  std::string err() const { return folder_ / "err"; }

 private:
  fs::path folder_;
};

std::string content_of(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool redirect(const std::string& path, int flags, int to) {
  const int descriptor = ::open(path.c_str(), flags, 0600);
  return descriptor >= 0 && ::dup2(descriptor, to) >= 0;
}

/// In the process that becomes the program. Only calls that are safe between fork and exec.
[[noreturn]] void become(const ChildProgram& program, const Streams& streams,
                         std::vector<char*>& words) {
  ::setpgid(0, 0);  // so that what it starts ends with it
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  const bool is_ready = redirect(streams.in(), O_RDONLY, STDIN_FILENO) &&
                        redirect(streams.out(), O_WRONLY | O_CREAT, STDOUT_FILENO) &&
                        redirect(streams.err(), O_WRONLY | O_CREAT, STDERR_FILENO) &&
                        (program.folder.empty() || ::chdir(program.folder.c_str()) == 0);
  if (is_ready) ::execvp(words.front(), words.data());
  ::_exit(could_not_start);
}

pid_t start(const ChildProgram& program, const Streams& streams) {
  std::vector<std::string> copies = program.command;
  std::vector<char*> words;
  for (std::string& word : copies) words.push_back(word.data());
  words.push_back(nullptr);
  const pid_t process = ::fork();
  if (process == 0) become(program, streams, words);
  if (process < 0) {
    throw SimulationError(
        fmt::format("{}: cannot be started: {}", command_text(program), std::strerror(errno)));
  }
  ::setpgid(process, process);
  return process;
}

/// The last lines, which tell most.
std::string tail_of(std::string text) {
  text.erase(text.find_last_not_of(" \n") + 1);
  constexpr std::size_t most = 600;
  const std::string end = text.size() > most ? "…" + text.substr(text.size() - most) : text;
  return end.empty() ? "it wrote nothing to standard error"
                     : fmt::format("it wrote to standard error: {}", end);
}

/// Ends the program where it still runs.
class RunningProgram {
 public:
  explicit RunningProgram(pid_t process) : process_(process) {}
  ~RunningProgram() {
    if (has_ended_) return;
    ::kill(-process_, SIGKILL);
    int status = 0;
    ::waitpid(process_, &status, 0);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// @returns whether it has ended, with its status
  bool has_ended(int& status) {
    const pid_t ended = ::waitpid(process_, &status, WNOHANG);
    has_ended_ = ended == process_ || (ended < 0 && errno == ECHILD);
    return has_ended_;
  }

 private:
  pid_t process_;
  bool has_ended_ = false;
};

int wait_for(const ChildProgram& program, pid_t process, const Streams& streams) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  RunningProgram running(process);
  int status = 0;
  while (!running.has_ended(status)) {
    check_stop();
    const std::chrono::duration<double> seconds = Clock::now() - begin;
    if (program.time_limit > 0.0 && seconds.count() > program.time_limit) {
      throw SimulationError(fmt::format("{}: has taken longer than its limit of {:g} s; {}",
                                        command_text(program), program.time_limit,
                                        tail_of(content_of(streams.err()))));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }
  return status;
}

}  // namespace

ProgramPermission::ProgramPermission() {
  ++permissions;
}

ProgramPermission::~ProgramPermission() {
  --permissions;
}

bool may_start_programs() {
  return permissions > 0;
}

std::string command_text(const ChildProgram& program) {
  return fmt::format("{}", fmt::join(program.command, " "));
}

std::string output_of(const ChildProgram& program, const std::string& input) {
  const Streams streams(input);
  const int status = wait_for(program, start(program, streams), streams);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return content_of(streams.out());
  const std::string end = WIFSIGNALED(status)
                              ? fmt::format("was ended by the signal {}", WTERMSIG(status))
                          : WEXITSTATUS(status) == could_not_start
                              ? std::string("could not be started; is it installed, and in PATH?")
                              : fmt::format("ended with the exit code {}", WEXITSTATUS(status));
  throw SimulationError(
      fmt::format("{}: {}; {}", command_text(program), end, tail_of(content_of(streams.err()))));
}

}  // namespace pleuel
