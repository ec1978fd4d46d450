#include "optimization/evaluation_cache.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// Line searches return to one of the last few designs, never to one of long ago.
constexpr std::size_t remembered_designs = 8;

/// What is not a finite number in the evaluation; empty if all is well.
std::string find_not_finite(const Problem& problem, const Evaluation& evaluation) {
  if (!std::isfinite(evaluation.objective)) {
    return fmt::format("{} is {}", problem.objective_name(), evaluation.objective);
  }
  for (Eigen::Index j = 0; j < evaluation.constraints.size(); ++j) {
    if (!std::isfinite(evaluation.constraints[j])) {
      return fmt::format("{} is {}", problem.constraints()[j].name, evaluation.constraints[j]);
    }
  }
  const bool gradients_finite =
      evaluation.objective_gradient.allFinite() && evaluation.constraint_jacobian.allFinite();
  return gradients_finite ? "" : "a gradient is not finite";
}

[[maybe_unused]] bool has_right_shape(const Problem& problem, const Evaluation& evaluation,
                                      Request request) {
  const Eigen::Index variables = problem.variables().size();
  const Eigen::Index constraints = problem.constraints().size();
  if (evaluation.constraints.size() != constraints) return false;
  if (request == Request::values) return true;
  return evaluation.objective_gradient.size() == variables &&
         evaluation.constraint_jacobian.rows() == constraints &&
         (constraints == 0 || evaluation.constraint_jacobian.cols() == variables);
}

}  // namespace

Attempt attempt_evaluation(Problem& problem, const Eigen::VectorXd& x, Request request) {
  try {
    Evaluation evaluation = problem.evaluate(x, request);
    assert(has_right_shape(problem, evaluation, request));
    std::string failure = find_not_finite(problem, evaluation);
    if (!failure.empty()) return {std::nullopt, std::move(failure)};
    return {std::move(evaluation), ""};
  } catch (const SimulationError& error) {
    return {std::nullopt, error.what()};
  }
}

EvaluationCache::EvaluationCache(Problem& problem, const EvaluatedDesign& start, Scales scales,
                                 Watch watch)
    : problem_(problem), scales_(std::move(scales)), watch_(std::move(watch)) {
  remember(start.x, Request::values_and_gradients, {start.evaluation, ""});
}

const Evaluation* EvaluationCache::evaluate(const Eigen::VectorXd& x, Request request) {
  const Entry* entry = find(x, request);
  if (entry == nullptr) {
    const bool values_were_known = has_values(x);
    if (gradients_fail_alone_) request = Request::values_and_gradients;
    entry = &remember(x, request, attempt_evaluation(problem_, x, request));
    if (values_were_known && !entry->evaluation) gradients_fail_alone_ = true;
  }
  return entry->evaluation ? &*entry->evaluation : nullptr;
}

double EvaluationCache::seconds() const {
  return watch_.time.seconds();
}

bool EvaluationCache::has_values(const Eigen::VectorXd& x) const {
  const Entry* entry = find(x, Request::values);
  return entry != nullptr && entry->evaluation.has_value();
}

const EvaluationCache::Entry* EvaluationCache::find(const Eigen::VectorXd& x,
                                                    Request request) const {
  const auto answers = [&](const Entry& entry) {
    const bool failed = !entry.evaluation;
    const bool enough = request == Request::values || entry.request == request || failed;
    return enough && entry.x == x;
  };
  const auto entry = std::find_if(entries_.begin(), entries_.end(), answers);
  return entry == entries_.end() ? nullptr : &*entry;
}

const EvaluationCache::Entry& EvaluationCache::remember(const Eigen::VectorXd& x, Request request,
                                                        Attempt attempt) {
  if (entries_.size() == remembered_designs) entries_.pop_back();
  entries_.push_front({x, request, std::move(attempt.evaluation)});
  record(entries_.front(), attempt.failure);
  return entries_.front();
}

void EvaluationCache::record(const Entry& entry, const std::string& failure) {
  const bool with_gradients = entry.request == Request::values_and_gradients;
  gradient_evaluations_ += with_gradients ? 1 : 0;
  const bool is_step = purpose_ != Purpose::audit;
  iterations_ += is_step && with_gradients && entry.evaluation ? 1 : 0;
  consecutive_failures_ = entry.evaluation ? 0 : consecutive_failures_ + 1;

  EvaluationRecord record;
  record.evaluation = evaluations() + 1;
  record.iteration = iterations_;
  record.purpose = purpose_;
  record.request = entry.request;
  record.x = entry.x;
  record.failure = failure;
  record.seconds = seconds();
  if (!history_.empty()) {
    record.step =
        (entry.x - history_.back().x).cwiseQuotient(scales_.variables).lpNorm<Eigen::Infinity>();
  }
  if (entry.evaluation) {
    record.objective = entry.evaluation->objective;
    record.constraints = entry.evaluation->constraints;
    record.max_violation = pleuel::max_violation(problem_, record.constraints, scales_.constraints);
  }
  history_.push_back(std::move(record));
  if (watch_.observer) watch_.observer(history_.back());
}

}  // namespace pleuel
