#include "mpi/relay.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include <sys/socket.h>
#include <unistd.h>

namespace pleuel {

namespace {

constexpr int tag = 1;
constexpr std::size_t most_bytes = 1 << 18;  ///< of a message

/// It looks again after so many nanoseconds, where the last news was within so many seconds: an answer
/// may be on its way, or a task at work.
struct Interval {
  double since;
  long nanoseconds;
};
constexpr std::array<Interval, 2> intervals = {{{2e-3, 50'000}, {0.2, 250'000}}};
constexpr long longest_interval = 1'000'000;  ///< [ns]

}  // namespace

Relay::Relay(int rank, const std::vector<int>& sockets) {
  for (std::size_t i = 0; i < sockets.size(); ++i) {
    Pipe pipe;
    pipe.socket = sockets[i];
    pipe.peer = rank == 0 ? static_cast<int>(i) + 1 : 0;
    pipes_.push_back(std::move(pipe));
  }
}

bool Relay::is_done() const {
  return sending_.empty() && std::none_of(pipes_.begin(), pipes_.end(), [](const Pipe& pipe) {
           return pipe.socket_is_open || pipe.peer_is_open || !pipe.to_socket.empty();
         });
}

void Relay::step() {
  bool has_news = take_messages();
  std::vector<pollfd> waiting = descriptors();
  const timespec time = has_news ? timespec{} : interval();
  if (::ppoll(waiting.data(), waiting.size(), &time, nullptr) > 0) {
    has_news = take_from_sockets(waiting) || has_news;
  }
  drop_sent();
  if (has_news) last_news_ = MPI_Wtime();
}

bool Relay::take_messages() {
  for (bool is_first = true;; is_first = false) {
    int is_there = 0, size = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &is_there, &status);
    if (is_there == 0) return !is_first;
    MPI_Get_count(&status, MPI_BYTE, &size);
    std::string bytes(size, '\0');
    MPI_Recv(bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, tag, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    Pipe& pipe = pipe_to(status.MPI_SOURCE);
    if (bytes.empty()) pipe.peer_is_open = false;
    pipe.to_socket += bytes;
    write(pipe);
  }
}

std::vector<pollfd> Relay::descriptors() const {
  std::vector<pollfd> all;
  for (const Pipe& pipe : pipes_) {
    const int reading = pipe.socket_is_open ? POLLIN : 0;
    const int writing = pipe.to_socket.empty() ? 0 : POLLOUT;
    const int events = reading | writing;
    // Without events there is nothing to be told: it is closed.
    all.push_back({events == 0 ? -1 : pipe.socket, static_cast<short>(events), 0});
  }
  return all;
}

timespec Relay::interval() const {
  const double since = sending_.empty() ? MPI_Wtime() - last_news_ : 0.0;
  for (const Interval& one : intervals) {
    if (since < one.since) return {0, one.nanoseconds};
  }
  return {0, longest_interval};
}

bool Relay::take_from_sockets(const std::vector<pollfd>& descriptors) {
  for (std::size_t i = 0; i < pipes_.size(); ++i) {
    if (descriptors[i].revents == 0) continue;
    if (!pipes_[i].to_socket.empty()) write(pipes_[i]);
    if (pipes_[i].socket_is_open && (descriptors[i].revents & ~POLLOUT) != 0) read(pipes_[i]);
  }
  return true;
}

void Relay::read(Pipe& pipe) {
  std::string bytes(most_bytes, '\0');
  const ssize_t count = ::read(pipe.socket, bytes.data(), bytes.size());
  if (count == -1 && (errno == EINTR || errno == EAGAIN)) return;
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  if (bytes.empty()) pipe.socket_is_open = false;
  send(pipe.peer, std::move(bytes));  // without any: the end of the pipe
}

void Relay::write(Pipe& pipe) {
  while (!pipe.to_socket.empty() && pipe.socket_listens) {
    const ssize_t count = ::send(pipe.socket, pipe.to_socket.data(), pipe.to_socket.size(),
                                 MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count == -1 && errno == EINTR) continue;
    if (count == -1 && errno == EAGAIN) return;
    if (count <= 0) {
      pipe.socket_listens = false;
    } else {
      pipe.to_socket.erase(0, count);
    }
  }
  if (!pipe.socket_listens) pipe.to_socket.clear();
  if (!pipe.peer_is_open) ::shutdown(pipe.socket, SHUT_WR);
}

void Relay::send(int peer, std::string bytes) {
  Sending& one = sending_.emplace_back();
  one.bytes = std::make_unique<std::string>(std::move(bytes));
  MPI_Isend(one.bytes->data(), static_cast<int>(one.bytes->size()), MPI_BYTE, peer, tag,
            MPI_COMM_WORLD, &one.request);
}

void Relay::drop_sent() {
  std::erase_if(sending_, [](Sending& one) {
    int has_ended = 0;
    MPI_Test(&one.request, &has_ended, MPI_STATUS_IGNORE);
    return has_ended != 0;
  });
}

Relay::Pipe& Relay::pipe_to(int peer) {
  return *std::find_if(pipes_.begin(), pipes_.end(),
                       [&](const Pipe& pipe) { return pipe.peer == peer; });
}

}  // namespace pleuel
