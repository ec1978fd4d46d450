#pragma once

#include "core/base/packed.hpp"
#include "optimization/result.hpp"

/// Results for other processes (core/base/packed.hpp). Each names all members of its struct.
namespace pleuel {

template <class Archive>
void transfer(Archive& archive, ErrorPart& part) {
  auto& [change, bound, is_resolved] = part;
  archive(change, bound, is_resolved);
}

template <class Archive>
void transfer(Archive& archive, ErrorBar& bar) {
  auto& [step, elements, newton, effects, order] = bar;
  archive(step, elements, newton, effects, order);
}

template <class Archive>
void transfer(Archive& archive, Evaluation& evaluation) {
  auto& [objective, constraints, objective_gradient, constraint_jacobian] = evaluation;
  archive(objective, constraints, objective_gradient, constraint_jacobian);
}

template <class Archive>
void transfer(Archive& archive, EvaluationRecord& record) {
  auto& [evaluation, iteration, purpose, request, x, failure, objective, constraints, violation,
         step, seconds, time_step, elements] = record;
  archive(evaluation, iteration, purpose, request, x, failure, objective, constraints, violation,
          step, seconds, time_step, elements);
}

template <class Archive>
void transfer(Archive& archive, SearchPart& part) {
  auto& [method, status, evaluations] = part;
  archive(method, status, evaluations);
}

template <class Archive>
void transfer(Archive& archive, ExceededLimit& limit) {
  auto& [constraint, is_upper, value, is_in_conflict, alone, together] = limit;
  archive(constraint, is_upper, value, is_in_conflict, alone, together);
}

template <class Archive>
void transfer(Archive& archive, LeastViolation& least) {
  auto& [x, violation, limits, is_proven] = least;
  archive(x, violation, limits, is_proven);
}

template <class Archive>
void transfer(Archive& archive, Result& result) {
  auto& [status, message, warnings, response_errors, response_bands, error, parts, least_violation,
         gradients_are_disproved, backend, polished_with, x, evaluation, constraint_multipliers,
         bound_multipliers, case_shares, case_objectives, kkt_residual, max_violation, evaluations,
         gradient_evaluations, iterations, restarts, seconds, history] = result;
  archive(status, message, warnings, response_errors, response_bands, error, parts, least_violation,
          gradients_are_disproved, backend, polished_with, x, evaluation, constraint_multipliers,
          bound_multipliers, case_shares, case_objectives, kkt_residual, max_violation, evaluations,
          gradient_evaluations, iterations, restarts, seconds, history);
}

}  // namespace pleuel
