#pragma once

#include <functional>
#include <utility>

#include "core/base/stopwatch.hpp"
#include "optimization/problem.hpp"
#include "optimization/result.hpp"

namespace pleuel {

/// Another problem, whose answers derived classes change or follow: the base of all that makes one problem of
/// another with the same variables.
class ProblemDecorator : public Problem {
 public:
  /// @param problem  must outlive this
  explicit ProblemDecorator(Problem& problem) : problem_(problem) {}

  const std::vector<Variable>& variables() const override { return problem_.variables(); }
  const std::vector<Constraint>& constraints() const override { return problem_.constraints(); }
  std::string objective_name() const override { return problem_.objective_name(); }
  std::string variable_text(std::size_t variable, double value) const override {
    return problem_.variable_text(variable, value);
  }
  std::string constraint_text(std::size_t constraint, double value) const override {
    return problem_.constraint_text(constraint, value);
  }
  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override {
    return problem_.evaluate(x, request);
  }

 protected:
  Problem& problem() { return problem_; }

 private:
  Problem& problem_;
};

/// A problem that begins at another design.
class StartedProblem : public ProblemDecorator {
 public:
  StartedProblem(Problem& problem, const Eigen::VectorXd& start)
      : ProblemDecorator(problem), variables_(problem.variables()) {
    set_start(variables_, start);
  }

  const std::vector<Variable>& variables() const override { return variables_; }

 private:
  std::vector<Variable> variables_;
};

/// A problem all of whose evaluations count as those of a restoration, whoever asks for them: they are added
/// to a run.
class RecordedProblem : public ProblemDecorator {
 public:
  using Completed = std::function<EvaluationRecord(EvaluationRecord)>;

  /// @param problem    must outlive this, and so must the observer
  /// @param run        gets effort and history
  /// @param completed  fills in what is not known here of a record, such as violations
  RecordedProblem(Problem& problem, Result& run, Completed completed, const Observer& observer)
      : ProblemDecorator(problem),
        run_(run),
        seconds_before_(run.seconds),
        completed_(std::move(completed)),
        observer_(observer) {}

  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override {
    Attempt attempt = attempt_evaluation(problem(), x, request);
    const int gradients = request == Request::values_and_gradients ? 1 : 0;
    run_.gradient_evaluations += gradients;
    EvaluationRecord record = record_of(x, request, attempt);
    record.purpose = Purpose::restoration;
    record.evaluation = ++run_.evaluations;
    record.iteration = run_.iterations += gradients;
    record.seconds = run_.seconds = seconds_before_ + watch_.seconds();
    run_.history.push_back(record.has_failed() ? record : completed_(record));
    show(observer_, run_.history.back());
    if (record.has_failed()) throw EvaluationFailure(attempt.failure);
    return std::move(*attempt.evaluation);
  }

 private:
  Result& run_;
  double seconds_before_;
  Completed completed_;
  const Observer& observer_;
  Stopwatch watch_;
};

}  // namespace pleuel
