#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/error_bar.hpp"
#include "optimization/broken_limits.hpp"
#include "optimization/history.hpp"
#include "optimization/problem.hpp"
#include "optimization/verdict.hpp"

namespace pleuel {

/// A part of the search for an optimum (find_optimum.hpp).
struct SearchPart {
  std::string method;  ///< a backend, or "restoration"
  Status status = Status::failed;
  int evaluations = 0;
};

struct Result {
  Status status = Status::failed;
  std::string message;  ///< a sentence: why this status
  /// Sentences: what speaks against the numbers of the last design.
  std::vector<std::string> warnings;
  int consequences = 0;  ///< so many of the last warnings follow from those before them
  /// Of responses and objective by steps, elements and effects; where a design problem knows them.
  std::vector<std::optional<ErrorBar>> response_errors;
  std::vector<Eigen::VectorXd> response_bands;  ///< of histories [SI]; empty where none is known
  std::optional<ErrorBar> error;                ///< of the optimal objective
  /// What was tried one after the other, where find_optimum() searched.
  std::vector<SearchPart> parts;
  /// Of an infeasible problem: what is in conflict.
  std::optional<LeastViolation> least_violation;
  bool gradients_are_disproved = false;  ///< by differences, where all else is well
  std::string backend;                   ///< that found the answer
  std::string polished_with;             ///< the backend that refined the answer; empty: nobody did
  Eigen::VectorXd x;                     ///< [SI]
  /// At x, with gradients. Without any entry if the start already failed.
  Evaluation evaluation;
  /// μ and β of KktAudit: d(optimal objective) / d(active limit) = −μ. That of a limit with slack
  /// is 0; see has_prices() of prices.hpp for the designs at which they are prices.
  Eigen::VectorXd constraint_multipliers, bound_multipliers;
  /// Where the worst of several load cases is minimized: how much of the optimum is that of each;
  /// they add up to 1. Empty elsewhere.
  Eigen::VectorXd case_shares = {};
  /// Of an objective over load cases: its response in each of them [SI]. Empty elsewhere.
  Eigen::VectorXd case_objectives = {};
  double kkt_residual = 0.0;   ///< relative
  double max_violation = 0.0;  ///< relative
  int evaluations = 0;
  int gradient_evaluations = 0;
  int iterations = 0;  ///< designs at which gradients were computed
  int restarts = 0;
  double seconds = 0.0;
  History history;
};

/// Whether a result is to be preferred: verified before unresolved before unproven, within the limits before
/// outside, with gradients before none; then the lower objective, or outside the smaller violation.
/// @param violation  relative, that still counts as within the limits
/// @param equal      relative difference of objectives that is none: the first one is preferred then; 0: the other
bool is_better(const Result& one, const Result& other, double violation, double equal = 0.0);

/// Puts what an earlier run of the same optimization did before a result: counts, time, history.
void continue_from(const Result& before, Result& result);

/// An answer with the counts, time and history of another result in place of its own.
Result with_effort_of(Result effort, Result answer);

/// A record as one that follows on a run.
EvaluationRecord following(EvaluationRecord record, const Result& before);

/// A run with an observer.
using ObservedRun = std::function<Result(const Observer& observer)>;

/// A run that goes on where an earlier one has ended: its records, in the result and for the observer, follow
/// on those before.
/// @param before  must not change during the run
Result run_after(const Result& before, const Observer& observer, const ObservedRun& run);

/// A run whose records, in the result and for the observer, are changed one by one.
Result run_with_records(const std::function<EvaluationRecord(EvaluationRecord)>& changed,
                        const Observer& observer, const ObservedRun& run);

}  // namespace pleuel
