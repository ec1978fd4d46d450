#include "core/base/task_failure.hpp"

#include <exception>
#include <new>
#include <stdexcept>

#include "core/base/error.hpp"
#include "core/base/stop.hpp"

namespace pleuel {

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
