#include "studies/varied_limit.hpp"

#include <optional>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/scene/case_goals.hpp"

namespace pleuel {

std::vector<std::size_t> varied_rows(const ProblemFile& problem) {
  std::vector<std::size_t> rows = constraints_of_limit(problem, problem.pareto->constraint);
  if (rows.empty()) throw InputError("/pareto/constraint names no constraint");
  return rows;
}

GoodSide good_side(const ProblemFile& problem) {
  return problem.constraints[varied_rows(problem).front()].upper ? GoodSide::low : GoodSide::high;
}

void set_limit(ProblemFile& problem, double limit) {
  for (const std::size_t row : varied_rows(problem)) {
    ConstraintSettings& constraint = problem.constraints[row];
    (constraint.upper ? constraint.upper : constraint.lower) = limit;
  }
}

double limited_value(const ProblemFile& problem, const Eigen::VectorXd& constraints) {
  std::optional<double> worst;
  for (const std::size_t row : varied_rows(problem)) {
    const double value = constraints(row);
    const bool is_upper = problem.constraints[row].upper.has_value();
    if (!worst || (is_upper ? value > *worst : value < *worst)) worst = value;
  }
  return *worst;
}

double multiplier_of_limit(const ProblemFile& problem, const Eigen::VectorXd& multipliers) {
  double sum = 0.0;
  for (const std::size_t row : varied_rows(problem)) {
    sum += multipliers(row);
  }
  return sum;
}

bool can_exchange_goals(const ProblemFile& problem) {
  if (!problem.pareto->goals.empty()) return true;
  if (problem.has_cases()) return false;
  const ConstraintSettings& limited = problem.constraints[varied_rows(problem).front()];
  return !limited.response.empty() && limited.deviations == 0.0;
}

ProblemFile with_exchanged_goals(ProblemFile problem, double objective_limit) {
  const std::vector<Objective> goals = problem.pareto->goals;
  const Objective objective = goals.empty() ? *problem.objective : goals[0];
  Objective limited;
  if (goals.empty()) {
    const ConstraintSettings& limit = problem.constraints[varied_rows(problem).front()];
    limited = {limit.response, limit.upper ? Aim::minimize : Aim::maximize};
  } else {
    limited = goals[1];
  }
  const std::string name = problem.pareto->constraint;
  remove_limit(problem, name);
  set_objective(problem, limited);
  add_limit(problem, objective, objective.sign() * objective_limit, name);
  return problem;
}

}  // namespace pleuel
