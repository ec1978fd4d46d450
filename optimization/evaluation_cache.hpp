#pragma once

#include <deque>
#include <optional>

#include <Eigen/Core>

#include "core/base/int_size.hpp"
#include "core/base/stopwatch.hpp"
#include "optimization/problem.hpp"
#include "optimization/result.hpp"

namespace pleuel {

/// A design together with what is known of it.
struct EvaluatedDesign {
  Eigen::VectorXd x;
  Evaluation evaluation;
  double max_violation = 0.0;  ///< relative
};

/// Backends ask for objective, constraints, and gradients of one design in separate calls: here one
/// evaluation serves them all. It counts and keeps the history.
class EvaluationCache {
 public:
  /// Magnitudes that stay the same over the run.
  struct Scales {
    Eigen::VectorXd variables;    ///< for the recorded step
    Eigen::VectorXd constraints;  ///< for relative violations
  };

  /// Who watches, and since when the time runs.
  struct Watch {
    Observer observer;
    Stopwatch time = {};
  };

  /// The first evaluation, that of the start, has been made: the scales follow from it.
  EvaluationCache(Problem& problem, const EvaluatedDesign& start, Scales scales, Watch watch);

  /// The evaluation at x, made only if it is not known yet; nullptr if it failed. The pointer is
  /// valid until the next call. Once gradients have failed where the values alone did not, values
  /// are always tried together with gradients: a backend can step back from a design that fails at
  /// once, but not from one that it has already accepted.
  const Evaluation* evaluate(const Eigen::VectorXd& x, Request request);

  /// What evaluations are made for from here on.
  void set_purpose(Purpose purpose) { purpose_ = purpose; }

  Problem& problem() const { return problem_; }
  const Scales& scales() const { return scales_; }
  const History& history() const { return history_; }
  int evaluations() const { return int_size(history_); }
  int gradient_evaluations() const { return gradient_evaluations_; }
  int iterations() const { return iterations_; }
  int consecutive_failures() const { return consecutive_failures_; }
  double seconds() const { return watch_.time.seconds(); }

 private:
  struct Entry {
    Eigen::VectorXd x;
    Request request;
    std::optional<Evaluation> evaluation;
  };

  const Entry* find(const Eigen::VectorXd& x, Request request) const;
  /// And records it.
  const Entry& remember(const Eigen::VectorXd& x, Request request, Attempt attempt);

  Problem& problem_;
  Scales scales_;
  Watch watch_;
  std::deque<Entry> entries_;  ///< the latest at the front
  History history_;
  Purpose purpose_ = Purpose::search;
  int gradient_evaluations_ = 0;
  int iterations_ = 0;
  int consecutive_failures_ = 0;
  bool gradients_fail_alone_ = false;
};

}  // namespace pleuel
