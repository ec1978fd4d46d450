#include "cli/rank_of_job.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "core/base/stop.hpp"

extern char** environ;  // NOLINT: that of POSIX

namespace pleuel {

namespace {

namespace fs = std::filesystem;

std::optional<int> number_of(const char* variable) {
  const char* text = std::getenv(variable);
  if (text == nullptr) return std::nullopt;
  int number = 0;
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), number);
  return error == std::errc() && *end == '\0' ? std::optional(number) : std::nullopt;
}

fs::path relay_program() {
  return fs::read_symlink("/proc/self/exe").parent_path() / "pleuel-mpi";
}

/// A library of this process that calls MPI shall not take itself for the rank.
void leave_environment() {
  std::vector<std::string> names;
  for (char** one = environ; *one != nullptr; ++one) {
    const std::string name(*one, std::strcspn(*one, "="));
    for (const char* prefix : {"OMPI_", "PMIX_", "PMI_", "PRTE_", "ORTE_"}) {
      if (name.starts_with(prefix)) names.push_back(name);
    }
  }
  for (const std::string& name : names) ::unsetenv(name.c_str());
}

extern "C" void note_lost_job(int /*signal*/) {
  request_stop();
}

/// In the process that does the work.
void leave_launcher(int rank, pid_t parent) {
  ::setpgid(0, 0);  // what mpirun kills is the other process: this one ends in good order
  if (rank == 0) std::signal(SIGUSR1, note_lost_job);
  ::prctl(PR_SET_PDEATHSIG, rank == 0 ? SIGUSR1 : SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it ended before that was said
  leave_environment();
}

/// Files of one process: two sockets a rank.
void allow_many_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

[[noreturn]] void become_relay(const fs::path& program, pid_t process, const RankOfJob& place,
                               const std::vector<int>& sockets) {
  std::vector<std::string> words = {program.string(), std::to_string(process),
                                    std::to_string(place.ranks)};
  for (const int socket : sockets) words.push_back(std::to_string(socket));
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(program.c_str(), arguments.data());
  ::kill(process, SIGKILL);
  ::_exit(1);
}

}  // namespace

std::optional<RankOfJob> rank_of_job() {
  struct Names {
    const char *rank, *ranks;
  };
  constexpr std::array<Names, 3> launchers = {{{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                               {"PMI_RANK", "PMI_SIZE"},
                                               {"PMIX_RANK", "SLURM_STEP_NUM_TASKS"}}};
  for (const Names& names : launchers) {
    const auto rank = number_of(names.rank), ranks = number_of(names.ranks);
    if (rank && ranks) return *ranks > 1 ? std::optional(RankOfJob{*rank, *ranks}) : std::nullopt;
  }
  return std::nullopt;
}

std::vector<Channel> join_job(const RankOfJob& place) {
  const fs::path program = relay_program();
  if (::access(program.c_str(), X_OK) != 0) {
    if (place.rank != 0) ::_exit(2);
    throw InputError(
        fmt::format("mpirun started {} of these, but this program was built without MPI: build it "
                    "anew where Open MPI is installed (Debian: libopenmpi-dev openmpi-bin), or "
                    "start it once, without mpirun, with --jobs",
                    place.ranks));
  }
  allow_many_files();
  std::vector<Channel> links;
  std::vector<int> others;  // ends of the relay
  for (int i = 0; i < (place.rank == 0 ? place.ranks - 1 : 1); ++i) {
    std::array<int, 2> ends;
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == -1) {
      throw std::runtime_error(fmt::format("no link to other ranks: {}", std::strerror(errno)));
    }
    links.emplace_back(ends[0]);
    others.push_back(ends[1]);
  }
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process == -1) {
    throw std::runtime_error(fmt::format("no second process: {}", std::strerror(errno)));
  }
  if (process > 0) {
    links.clear();
    become_relay(program, process, place, others);
  }
  for (const int socket : others) ::close(socket);
  leave_launcher(place.rank, parent);
  return links;
}

}  // namespace pleuel
