#include "cli/interruption.hpp"

#include <csignal>
#include <exception>
#include <filesystem>
#include <new>

#include "core/base/error.hpp"
#include "core/base/quoted.hpp"
#include "core/base/stop.hpp"

namespace pleuel {

namespace {

constexpr std::array signals = {SIGINT, SIGTERM, SIGHUP};

extern "C" void record_interruption(int signal) {
  request_stop();
  std::signal(signal, SIG_DFL);
}

namespace fs = std::filesystem;

/// "/tmp/aaaa…: File name too long": long names are told by their beginnings.
std::string path_text(const fs::filesystem_error& error) {
  return fmt::format("{}: the system says: {}", excerpt(error.path1().string(), 120),
                     error.code().message());
}

}  // namespace

Interruption::Interruption() {
  for (std::size_t i = 0; i < signals.size(); ++i) {
    before_[i] = std::signal(signals[i], record_interruption);
    // A program started in the background ignores interrupts, one of nohup the end of its terminal,
    // and shall go on doing so.
    if (before_[i] == SIG_IGN) std::signal(signals[i], SIG_IGN);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < signals.size(); ++i) std::signal(signals[i], before_[i]);
}

Failure current_failure() {
  try {
    throw;
  } catch (const InputError& error) {
    return {ExitCode::bad_input, error.what()};
  } catch (const SimulationError& error) {
    return {ExitCode::simulation_failed, error.what()};
  } catch (const fs::filesystem_error& error) {  // of a path that the user gave
    return {ExitCode::bad_input, path_text(error)};
  } catch (const Stopped&) {
    return {ExitCode::not_verified, "interrupted before there was any result", true};
  } catch (const std::bad_alloc&) {
    return {ExitCode::bad_input,
            "the memory of the machine is used up: take a longer /simulation/step or a "
            "shorter /simulation/end_time, a smaller /sensitivity/memory (then stretches are "
            "simulated again), or fewer --jobs"};
  } catch (const std::exception& error) {
    return {ExitCode::fault, fmt::format("{} (this is a fault of the program)", error.what())};
  }
}

}  // namespace pleuel
