#include "optimization/result.hpp"

#include <cmath>
#include <utility>

namespace pleuel {

namespace {

int rank(const Result& result, double violation) {
  if (!result.evaluation.has_gradients()) return 0;
  if (result.status == Status::verified) return 4;
  if (result.status == Status::unresolved) return 3;
  return result.max_violation <= violation ? 2 : 1;
}

}  // namespace

bool is_better(const Result& one, const Result& other, double violation, double equal) {
  const int order = rank(one, violation);
  if (order != rank(other, violation)) return order > rank(other, violation);
  if (order == 0) return false;
  if (order == 1) return one.max_violation < other.max_violation;
  const double more = one.evaluation.objective - other.evaluation.objective;
  return more < 0.0 || (equal > 0.0 && more <= equal * std::abs(other.evaluation.objective));
}

void continue_from(const Result& before, Result& result) {
  for (EvaluationRecord& record : result.history) record = following(std::move(record), before);
  result.history.insert(result.history.begin(), before.history.begin(), before.history.end());
  result.evaluations += before.evaluations;
  result.gradient_evaluations += before.gradient_evaluations;
  result.iterations += before.iterations;
  result.restarts += before.restarts;
  result.seconds += before.seconds;
}

Result with_effort_of(Result effort, Result answer) {
  answer.history = std::move(effort.history);
  answer.evaluations = effort.evaluations;
  answer.gradient_evaluations = effort.gradient_evaluations;
  answer.iterations = effort.iterations;
  answer.restarts = effort.restarts;
  answer.seconds = effort.seconds;
  return answer;
}

EvaluationRecord following(EvaluationRecord record, const Result& before) {
  record.evaluation += before.evaluations;
  record.iteration += before.iterations;
  record.seconds += before.seconds;
  return record;
}

Result run_after(const Result& before, const Observer& observer, const ObservedRun& run) {
  Result result =
      run([&](const EvaluationRecord& record) { show(observer, following(record, before)); });
  continue_from(before, result);
  return result;
}

Result run_with_records(const std::function<EvaluationRecord(EvaluationRecord)>& changed,
                        const Observer& observer, const ObservedRun& run) {
  History history;
  Result result = run([&](const EvaluationRecord& record) {
    history.push_back(changed(record));
    show(observer, history.back());
  });
  result.history = std::move(history);
  return result;
}

}  // namespace pleuel
