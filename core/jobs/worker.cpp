#include "core/jobs/worker.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "core/base/stop.hpp"

namespace pleuel {

namespace {

constexpr std::size_t header_size = 1 + sizeof(std::uint64_t);

/// Where a worker has its connection; everything above is closed, as locks and files are not its
/// business.
constexpr int worker_descriptor = 3;

std::atomic<int> prohibitions = 0;

bool write_all_to(int descriptor, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::send(descriptor, data, size, MSG_NOSIGNAL);
    if (written == -1 && errno == EINTR) continue;
    if (written <= 0) return false;
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

[[noreturn]] void run_worker(int descriptor, pid_t parent,
                             const std::function<void(Channel&)>& work) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it ended before that was said
  if (descriptor != worker_descriptor) ::dup2(descriptor, worker_descriptor);
  ::close_range(worker_descriptor + 1, ~0u, 0);
  Channel channel(worker_descriptor);
  work(channel);
  ::_exit(0);  // nothing that the parent began is to be ended or flushed here
}

}  // namespace

Channel::~Channel() {
  if (descriptor_ != -1) ::close(descriptor_);
}

Channel::Channel(Channel&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), buffer_(std::move(other.buffer_)) {}

Channel& Channel::operator=(Channel&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(buffer_, other.buffer_);
  return *this;
}

bool Channel::send(const Frame& frame) const {
  std::string bytes(header_size, '\0');
  const std::uint64_t size = frame.content.size();
  bytes[0] = static_cast<char>(frame.kind);
  std::memcpy(bytes.data() + 1, &size, sizeof size);
  bytes += frame.content;
  return write_all_to(descriptor_, bytes.data(), bytes.size());
}

bool Channel::receive(Frame& frame) {
  while (!take(frame)) {
    if (!read_some()) return false;
  }
  return true;
}

bool Channel::receive_available(std::vector<Frame>& frames) {
  const bool is_there = read_some();
  for (Frame frame; take(frame);) frames.push_back(std::move(frame));
  return is_there;
}

bool Channel::read_some() {
  std::array<char, 65536> bytes;
  for (;;) {
    const ssize_t count = ::read(descriptor_, bytes.data(), bytes.size());
    if (count == -1 && errno == EINTR) continue;
    if (count <= 0) return false;
    buffer_.append(bytes.data(), static_cast<std::size_t>(count));
    return true;
  }
}

bool Channel::take(Frame& frame) {
  if (buffer_.size() < header_size) return false;
  std::uint64_t size = 0;
  std::memcpy(&size, buffer_.data() + 1, sizeof size);
  if (buffer_.size() - header_size < size) return false;
  frame.kind = static_cast<Frame::Kind>(buffer_[0]);
  frame.content = buffer_.substr(header_size, size);
  buffer_.erase(0, header_size + size);
  return true;
}

WorkersForbidden::WorkersForbidden() noexcept {
  ++prohibitions;
}

WorkersForbidden::~WorkersForbidden() {
  --prohibitions;
}

Worker::Worker(const std::function<void(Channel&)>& work) : Worker(forked(work)) {}

Worker Worker::forked(const std::function<void(Channel&)>& work) {
  if (prohibitions > 0) throw NoWorker("no worker process: this process makes none");
  std::array<int, 2> ends;
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == -1) {
    throw NoWorker(fmt::format("no worker process: {}", std::strerror(errno)));
  }
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process == 0) run_worker(ends[1], parent, work);
  const int error = errno;
  ::close(ends[1]);
  if (process == -1) {
    ::close(ends[0]);
    throw NoWorker(fmt::format("no worker process: {}", std::strerror(error)));
  }
  return {process, ends[0]};
}

Worker::Worker(Worker&& other) noexcept
    : process_(std::exchange(other.process_, -1)), channel_(std::move(other.channel_)) {}

Worker& Worker::operator=(Worker&& other) noexcept {
  std::swap(process_, other.process_);
  std::swap(channel_, other.channel_);
  return *this;
}

Worker::~Worker() {
  if (process_ == -1) return;
  kill();
  end();
}

void Worker::ask_to_end() const {
  ::kill(process_, SIGTERM);
}

void Worker::kill() const {
  ::kill(process_, SIGKILL);
}

std::string Worker::end() {
  int status = 0;
  while (::waitpid(process_, &status, 0) == -1 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFSIGNALED(status)) {
    return fmt::format("signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  }
  const int code = WEXITSTATUS(status);
  return code == 0 ? "" : fmt::format("exit code {}", code);
}

namespace {

enum class Thrown : char { input, simulation, memory, stopped, other };

std::string report_of(Thrown kind, const std::string& text) {
  return std::string(1, static_cast<char>(kind)) + text;
}

}  // namespace

std::string thrown_report() {
  try {
    throw;
  } catch (const InputError& error) {
    return report_of(Thrown::input, error.what());
  } catch (const SimulationError& error) {
    return report_of(Thrown::simulation, error.what());
  } catch (const Stopped&) {
    return report_of(Thrown::stopped, "");
  } catch (const std::bad_alloc&) {
    return report_of(Thrown::memory, "");
  } catch (const std::exception& error) {
    return report_of(Thrown::other, error.what());
  }
}

bool is_stop(const std::string& report) {
  return report.at(0) == static_cast<char>(Thrown::stopped);
}

void throw_again(const std::string& report) {
  const std::string text = report.substr(1);
  switch (static_cast<Thrown>(report[0])) {
    case Thrown::input:
      throw InputError(text);
    case Thrown::simulation:
      throw SimulationError(text);
    case Thrown::memory:
      throw std::bad_alloc();
    case Thrown::stopped:
    case Thrown::other:
      break;
  }
  throw std::runtime_error(text);
}

}  // namespace pleuel
