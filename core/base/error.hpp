#pragma once

#include <optional>
#include <stdexcept>
#include <string>

namespace pleuel {

/// What the user gave cannot be used: the message names the file, the JSON pointer, the value and
/// the rule. The command ends with exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The simulation could not go on: the message says where (time, step, iteration, residual) and
/// what to try. The command ends with exit code 3; an optimizer sees a failed evaluation.
class SimulationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  SimulationError(const std::string& text, std::optional<double> time)
      : std::runtime_error(text), time_(time) {}

  /// Of the step that failed [s]; none where something else than a step did.
  std::optional<double> time() const { return time_; }

 private:
  std::optional<double> time_;
};

}  // namespace pleuel
