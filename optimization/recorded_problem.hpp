#pragma once

#include <chrono>
#include <functional>

#include "optimization/history.hpp"
#include "optimization/problem.hpp"

namespace pleuel {

/// A problem all of whose evaluations are recorded as those of a restoration, whoever asks for
/// them. Violations are not known here: `completed` fills them in.
class RecordedProblem : public Problem {
 public:
  using Completed = std::function<EvaluationRecord(EvaluationRecord)>;

  /// @param problem  must outlive this, and so must the observer
  RecordedProblem(Problem& problem, Completed completed, const Observer& observer)
      : problem_(problem),
        completed_(std::move(completed)),
        observer_(observer),
        begin_(std::chrono::steady_clock::now()) {}

  const std::vector<Variable>& variables() const override { return problem_.variables(); }
  const std::vector<Constraint>& constraints() const override { return problem_.constraints(); }
  std::string objective_name() const override { return problem_.objective_name(); }
  std::string variable_text(std::size_t variable, double value) const override {
    return problem_.variable_text(variable, value);
  }
  std::string constraint_text(std::size_t constraint, double value) const override {
    return problem_.constraint_text(constraint, value);
  }
  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override;

  const History& history() const { return history_; }
  int gradient_evaluations() const { return gradients_; }
  double seconds() const;

 private:
  void record(const Eigen::VectorXd& x, Request request, const Evaluation* evaluation,
              const std::string& failure);

  Problem& problem_;
  Completed completed_;
  const Observer& observer_;
  std::chrono::steady_clock::time_point begin_;
  History history_;
  int gradients_ = 0;
};

}  // namespace pleuel
