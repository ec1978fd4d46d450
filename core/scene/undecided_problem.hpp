#pragma once

#include <utility>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// A problem as its file says it. Where the file has a tolerance of effects, simulations decide what
/// that leaves out; nobody has asked them yet, so that it has to be said which model is meant:
/// complete(), or decided() (core/response/effect_measurement.hpp).
class UndecidedProblem {
 public:
  explicit UndecidedProblem(ProblemFile complete) : complete_(std::move(complete)) {}

  /// With all effects that the file does not forbid, whatever its tolerance. Names, units and limits
  /// are the same in both.
  const ProblemFile& complete() const& { return complete_; }
  ProblemFile complete() && { return std::move(complete_); }

 private:
  ProblemFile complete_;
};

}  // namespace pleuel
