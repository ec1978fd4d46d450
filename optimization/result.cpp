#include "optimization/result.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/number_text.hpp"

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

std::string to_string(Status status) {
  constexpr std::array<const char*, 6> names = {"verified",   "unresolved", "stalled",
                                                "infeasible", "failed",     "interrupted"};
  return names[static_cast<std::size_t>(status)];
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
  const auto first = std::ranges::find_if_not(history, std::mem_fn(&EvaluationRecord::has_failed));
  return first == history.end() ? history.front() : *first;
}

namespace {

std::string broken_text(const Problem& problem, std::size_t row, double value) {
  const Constraint& limits = problem.constraints()[row];
  const bool is_above = value > limits.upper;
  return fmt::format("{} = {} {} {}", limits.name, problem.constraint_text(row, value),
                     is_above ? "exceeds its upper limit" : "falls below its lower limit",
                     problem.constraint_text(row, is_above ? limits.upper : limits.lower));
}

/// 0.0713 of 0.07124 for an upper limit: what is named suffices.
double rounded_outward(double value, bool is_upper) {
  if (value == 0.0) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3.0);
  const double slack = 1e-4 * unit;  // 0.5 is not to become 0.5001 by rounding errors
  return unit * (is_upper ? std::ceil((value - slack) / unit) : std::floor((value + slack) / unit));
}

std::string limit_text(const Problem& problem, const ExceededLimit& one, double value) {
  return fmt::format("{} {} {}", problem.constraints()[one.constraint].name,
                     one.is_upper ? "≤" : "≥", problem.constraint_text(one.constraint, value));
}

std::string changed_text(const Problem& problem, const ExceededLimit& one, double value) {
  return limit_text(problem, one, rounded_outward(value, one.is_upper));
}

/// "by 25.0 %", "by 340 times the limit"
std::string violation_text(double violation) {
  constexpr double hard_to_read = 10.0;
  return violation < hard_to_read ? "by " + percent(violation)
                                  : fmt::format("by {:.3g} times the limit", violation);
}

std::string joined(const std::vector<std::string>& texts, const std::string& last) {
  if (texts.size() == 1) return texts.front();
  const std::vector<std::string> first(texts.begin(), texts.end() - 1);
  return fmt::format("{}{}{}", fmt::join(first, ", "), last, texts.back());
}

}  // namespace

std::string broken_limits(const Problem& problem, const Eigen::VectorXd& constraints,
                          const Eigen::VectorXd& scales, double allowed) {
  std::vector<std::pair<double, std::size_t>> broken;  // relative violation, row
  for (std::size_t row = 0; row < problem.constraints().size(); ++row) {
    const double excess = problem.constraints()[row].excess(constraints[row]);
    if (excess > allowed * scales[row]) broken.emplace_back(excess / scales[row], row);
  }
  std::ranges::stable_sort(broken, std::greater(), [](const auto& one) { return one.first; });
  std::vector<std::string> names, texts;
  for (const auto& [violation, row] : broken) {
    const std::string& name = problem.constraints()[row].name;
    if (std::ranges::find(names, name) != names.end()) continue;
    names.push_back(name);
    texts.push_back(broken_text(problem, row, constraints[row]));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string describe(const LeastViolation& least, const Problem& problem) {
  if (least.limits.empty()) return "";
  std::vector<std::string> conflict, alone, hopeless, together;
  for (const ExceededLimit& one : least.limits) {
    if (one.is_in_conflict) conflict.push_back(limit_text(problem, one, one.limit));
    if (one.alone) {
      alone.push_back(changed_text(problem, one, *one.alone));
    } else if (one.is_in_conflict) {
      hopeless.push_back(problem.constraints()[one.constraint].name);
    }
    together.push_back(changed_text(problem, one, one.together));
  }
  std::string text = joined(conflict, " and ") + " cannot be kept";
  if (conflict.size() > 1) text += " at once";
  text += fmt::format("; this design breaks its limits least, {}{}",
                      violation_text(least.violation), least.limits.size() > 1 ? " at most" : "");
  if (!alone.empty()) text += ". One change would do: " + joined(alone, ", or ");
  if (!alone.empty() && alone.size() < conflict.size()) {
    text +=
        fmt::format("; for {} alone no value was found that would do", joined(hopeless, " and "));
  }
  if (!alone.empty() && least.limits.size() == 1) return text;
  text += alone.empty() ? ". What would do together: " : "; or all of these: ";
  return text + joined(together, " and ");
}

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

bool has_prices(const Result& result) {
  constexpr double nearly_optimal = 1e-2;
  if (!result.evaluation.has_gradients()) return false;
  return result.is_optimum() ||
         (result.status == Status::stalled && result.kkt_residual <= nearly_optimal);
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
