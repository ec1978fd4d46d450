#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <sys/wait.h>

#include "mpi/relay.hpp"

/// pleuel-mpi PROCESS RANKS SOCKET…: carries messages for a process of pleuel, whose parent it has
/// become, until that has ended; ends as that did.
namespace pleuel {

namespace {

std::atomic<bool> is_asked_to_end = false;

extern "C" void note_end(int /*signal*/) {
  is_asked_to_end = true;
}

/// Requests to end, of mpirun or passed on by it (SIGUSR1), are for the process of rank 0, which
/// ends the others in good order.
void pass_on_end(int rank, pid_t process) {
  if (is_asked_to_end.exchange(false) && rank == 0) ::kill(process, SIGTERM);
}

int exit_code_of(pid_t process) {
  int status = 0;
  while (::waitpid(process, &status, 0) == -1 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int carry(int argc, char** argv) {
  const auto process = static_cast<pid_t>(std::atoi(argv[1]));
  std::vector<int> sockets;
  for (int i = 3; i < argc; ++i) sockets.push_back(std::atoi(argv[i]));
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, note_end);
  int rank = 0, ranks = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks != std::atoi(argv[2])) {
    std::fprintf(stderr,
                 "pleuel: MPI knows of %d ranks where mpirun says %s: it is that of another MPI "
                 "than pleuel was built with\n",
                 ranks, argv[2]);
    ::kill(process, SIGKILL);
    return 2;
  }
  Relay(rank, sockets).run([&] { pass_on_end(rank, process); });
  const int code = exit_code_of(process);
  return rank == 0 ? code : 0;
}

}  // namespace

}  // namespace pleuel

int main(int argc, char** argv) {
  if (argc < 4) return 1;
  MPI_Init(nullptr, nullptr);
  const int code = pleuel::carry(argc, argv);
  MPI_Finalize();
  return code;
}
