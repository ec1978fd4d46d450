#pragma once

#include <cstdio>

#include "cli/shown_unit.hpp"
#include "optimization/history.hpp"

namespace pleuel {

/// A line for each iteration, and for each failed evaluation, while the optimizer works.
class IterationLines {
 public:
  IterationLines(std::FILE* out, const ProblemFile& problem);
  void see(const EvaluationRecord& record);

 private:
  std::FILE* out_;
  ShownUnit unit_;
  int iteration_ = 0;
  double step_ = 0.0;  ///< the longest since the line before
};

}  // namespace pleuel
