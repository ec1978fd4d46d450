#include "optimization/history.hpp"

#include <algorithm>

namespace pleuel {

std::string to_string(Purpose purpose) {
  switch (purpose) {
    case Purpose::search:
      return "search";
    case Purpose::polish:
      return "polish";
    case Purpose::restoration:
      return "restoration";
    case Purpose::audit:
      return "audit";
    default:
      return "trial";
  }
}

EvaluationRecord record_of(const Eigen::VectorXd& x, Request request, const Attempt& attempt) {
  EvaluationRecord record;
  record.x = x;
  record.request = request;
  record.failure = attempt.failure;
  if (!attempt.evaluation) return record;
  record.objective = attempt.evaluation->objective;
  record.constraints = attempt.evaluation->constraints;
  return record;
}

const EvaluationRecord& best_record(const History& history, double allowed_violation) {
  const auto is_better = [&](const EvaluationRecord& one, const EvaluationRecord& other) {
    if (one.has_failed()) return false;
    const bool both_allowed = std::max(one.max_violation, other.max_violation) <= allowed_violation;
    return both_allowed ? one.objective < other.objective : one.max_violation < other.max_violation;
  };
  const EvaluationRecord* best = &first_design(history);
  for (const EvaluationRecord& record : history) {
    if (is_better(record, *best)) best = &record;
  }
  return *best;
}

const EvaluationRecord& first_design(const History& history) {
  const auto first =
      std::find_if_not(history.begin(), history.end(), std::mem_fn(&EvaluationRecord::has_failed));
  return first == history.end() ? history.front() : *first;
}

}  // namespace pleuel
