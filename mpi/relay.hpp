#pragma once

#include <csignal>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include <mpi.h>
#include <poll.h>

namespace pleuel {

/// Carries bytes between the ranks of an MPI job: a pipe from rank 0 to each other rank and back.
/// At either end of a pipe is a socket of the process that does the work, which knows nothing of
/// MPI; this process does nothing else, and never forks.
///
/// Nothing here waits for anybody: what cannot be sent or written yet is kept. As MPI has no way to
/// sleep until a message comes, it looks for one in short intervals, which grow while nothing
/// happens.
class Relay {
 public:
  /// @param sockets  on rank 0 one for each other rank, in their order; else the one to rank 0
  Relay(int rank, const std::vector<int>& sockets);

  /// Until both ends of all pipes are closed.
  /// @param see_interval  called again and again
  template <class Function>
  void run(const Function& see_interval) {
    while (!is_done()) {
      see_interval();
      step();
    }
  }

 private:
  struct Pipe {
    int socket = -1;
    int peer = 0;                ///< rank at the other end
    std::string to_socket;       ///< that could not be written yet
    bool socket_is_open = true;  ///< it has more to say
    bool peer_is_open = true;    ///< it has more to say
    bool socket_listens = true;  ///< it takes what the peer says
  };

  /// On its way; MPI reads the bytes until the request has ended.
  struct Sending {
    MPI_Request request = MPI_REQUEST_NULL;
    std::unique_ptr<std::string> bytes;
  };

  bool is_done() const;
  void step();
  bool take_messages();
  bool take_from_sockets(const std::vector<pollfd>& descriptors);
  void read(Pipe& pipe);
  void write(Pipe& pipe);
  void send(int peer, std::string bytes);
  void drop_sent();
  std::vector<pollfd> descriptors() const;
  timespec interval() const;
  Pipe& pipe_to(int peer);

  std::vector<Pipe> pipes_;
  std::deque<Sending> sending_;
  double last_news_ = 0.0;  ///< when something was carried [s]
};

}  // namespace pleuel
