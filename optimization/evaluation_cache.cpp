#include "optimization/evaluation_cache.hpp"

#include <algorithm>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// Line searches return to one of the last few designs, never to one of long ago.
constexpr std::size_t remembered_designs = 8;

}  // namespace

EvaluationCache::EvaluationCache(Problem& problem, const EvaluatedDesign& start, Scales scales,
                                 Watch watch)
    : problem_(problem), scales_(std::move(scales)), watch_(std::move(watch)) {
  remember(start.x, Request::values_and_gradients, {start.evaluation, ""});
}

const Evaluation* EvaluationCache::evaluate(const Eigen::VectorXd& x, Request request) {
  const Entry* entry = find(x, request);
  if (entry == nullptr) {
    const Entry* values = find(x, Request::values);
    const bool values_were_known = values != nullptr && values->evaluation.has_value();
    if (gradients_fail_alone_) request = Request::values_and_gradients;
    entry = &remember(x, request, attempt_evaluation(problem_, x, request));
    if (values_were_known && !entry->evaluation) gradients_fail_alone_ = true;
  }
  return entry->evaluation ? &*entry->evaluation : nullptr;
}

const EvaluationCache::Entry* EvaluationCache::find(const Eigen::VectorXd& x,
                                                    Request request) const {
  const auto answers = [&](const Entry& entry) {
    const bool failed = !entry.evaluation;
    const bool enough = request == Request::values || entry.request == request || failed;
    return enough && entry.x == x;
  };
  const auto entry = std::ranges::find_if(entries_, answers);
  return entry == entries_.end() ? nullptr : &*entry;
}

const EvaluationCache::Entry& EvaluationCache::remember(const Eigen::VectorXd& x, Request request,
                                                        Attempt attempt) {
  const bool with_gradients = request == Request::values_and_gradients;
  const bool has_failed = !attempt.evaluation;
  gradient_evaluations_ += with_gradients ? 1 : 0;
  iterations_ += purpose_ != Purpose::audit && with_gradients && !has_failed ? 1 : 0;
  consecutive_failures_ = has_failed ? consecutive_failures_ + 1 : 0;

  EvaluationRecord record = record_of(x, request, attempt);
  record.evaluation = evaluations() + 1;
  record.iteration = iterations_;
  record.purpose = purpose_;
  record.seconds = seconds();
  if (!history_.empty()) {
    record.step =
        (x - history_.back().x).cwiseQuotient(scales_.variables).lpNorm<Eigen::Infinity>();
  }
  if (!has_failed) {
    record.max_violation = max_violation(problem_, record.constraints, scales_.constraints);
  }
  history_.push_back(std::move(record));
  show(watch_.observer, history_.back());
  if (entries_.size() == remembered_designs) entries_.pop_back();
  entries_.push_front({x, request, std::move(attempt.evaluation)});
  return entries_.front();
}

}  // namespace pleuel
