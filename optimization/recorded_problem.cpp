#include "optimization/recorded_problem.hpp"

#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

Evaluation RecordedProblem::evaluate(const Eigen::VectorXd& x, Request request) {
  gradients_ += request == Request::values_and_gradients ? 1 : 0;
  try {
    Evaluation evaluation = problem().evaluate(x, request);
    record(x, request, &evaluation, "");
    return evaluation;
  } catch (const SimulationError& error) {
    record(x, request, nullptr, error.what());
    throw;
  }
}

void RecordedProblem::record(const Eigen::VectorXd& x, Request request,
                             const Evaluation* evaluation, const std::string& failure) {
  EvaluationRecord record;
  record.evaluation = int_size(history_) + 1;
  record.iteration = gradients_;
  record.purpose = Purpose::restoration;
  record.request = request;
  record.x = x;
  record.failure = failure;
  record.seconds = seconds();
  if (evaluation != nullptr) {
    record.objective = evaluation->objective;
    record.constraints = evaluation->constraints;
    record = completed_(std::move(record));
  }
  history_.push_back(std::move(record));
  if (observer_) observer_(history_.back());
}

}  // namespace pleuel
