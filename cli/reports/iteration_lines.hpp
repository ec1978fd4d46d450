#pragma once

#include <cstdio>

#include "core/scene/shown_unit.hpp"
#include "optimization/result.hpp"

namespace pleuel {

/// A line for each iteration, for each failed evaluation, and where an audit or a polish begins or
/// ends, while the optimizer works. Designs of an audit are no iterations. Of a choice of sizes there is
/// one line, that of its best design.
class IterationLines {
 public:
  IterationLines(std::FILE* out, const ProblemFile& problem);
  void see(const EvaluationRecord& record);

 private:
  void print(const EvaluationRecord& record);

  std::FILE* out_;
  ShownUnit unit_;
  double sign_;  ///< Objective::sign()
  Purpose purpose_ = Purpose::search;
  int iteration_ = 0;
  double step_ = 0.0;                      ///< the longest since the line before
  std::optional<EvaluationRecord> trial_;  ///< the best of a choice that has no line yet
};

}  // namespace pleuel
