#pragma once

#include <functional>

#include "core/base/stopwatch.hpp"
#include "optimization/forwarding_problem.hpp"
#include "optimization/history.hpp"

namespace pleuel {

/// A problem all of whose evaluations are recorded as those of a restoration, whoever asks for
/// them. Violations are not known here: `completed` fills them in.
class RecordedProblem : public ForwardingProblem {
 public:
  using Completed = std::function<EvaluationRecord(EvaluationRecord)>;

  /// @param problem  must outlive this, and so must the observer
  RecordedProblem(Problem& problem, Completed completed, const Observer& observer)
      : ForwardingProblem(problem), completed_(std::move(completed)), observer_(observer) {}

  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override;

  const History& history() const { return history_; }
  int gradient_evaluations() const { return gradients_; }
  double seconds() const { return watch_.seconds(); }

 private:
  void record(const Eigen::VectorXd& x, Request request, const Evaluation* evaluation,
              const std::string& failure);

  Completed completed_;
  const Observer& observer_;
  Stopwatch watch_;
  History history_;
  int gradients_ = 0;
};

}  // namespace pleuel
