#include "optimization/problem.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

/// Relative distance outside a bound that unit conversion alone can cause.
constexpr double rounding = 1e-12;

void check_order(const std::string& what, double lower, double upper) {
  if (!(lower <= upper)) {
    throw InputError(fmt::format("{}: the lower limit {} must not exceed the upper limit {}", what,
                                 lower, upper));
  }
}

double checked_start(const Variable& variable) {
  check_order("variable " + variable.name, variable.lower, variable.upper);
  const double slack = rounding * std::abs(variable.start);
  const bool inside =
      variable.start >= variable.lower - slack && variable.start <= variable.upper + slack;
  if (!std::isfinite(variable.start) || !inside) {
    throw InputError(fmt::format("variable {}: the start {} lies outside its bounds [{}, {}]",
                                 variable.name, variable.start, variable.lower, variable.upper));
  }
  return std::clamp(variable.start, variable.lower, variable.upper);
}

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

std::string Problem::variable_text(std::size_t, double value) const {
  return fmt::format("{:.6g}", value);
}

std::string Problem::constraint_text(std::size_t, double value) const {
  return fmt::format("{:.6g}", value);
}

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

Eigen::VectorXd start_of(const Problem& problem) {
  Eigen::VectorXd start(problem.variables().size());
  for (Eigen::Index i = 0; i < start.size(); ++i) start[i] = problem.variables()[i].start;
  return start;
}

Eigen::VectorXd checked_start(const Problem& problem) {
  const std::vector<Variable>& variables = problem.variables();
  if (variables.empty()) throw InputError("there is nothing to optimize: no variables are given");
  for (const Constraint& constraint : problem.constraints()) {
    check_order("constraint " + constraint.name, constraint.lower, constraint.upper);
  }
  Eigen::VectorXd start(variables.size());
  for (Eigen::Index i = 0; i < start.size(); ++i) start[i] = checked_start(variables[i]);
  return start;
}

void set_start(std::vector<Variable>& variables, const Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < variables.size(); ++i) variables[i].start = x[i];
}

Eigen::VectorXd within_bounds(const Problem& problem, Eigen::VectorXd x) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Variable& variable = problem.variables()[i];
    x[i] = std::clamp(x[i], variable.lower, variable.upper);
  }
  return x;
}

std::string describe_design(const Problem& problem, const Eigen::VectorXd& x) {
  std::string text;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    text += fmt::format("{}{} = {}", i == 0 ? "" : ", ", problem.variables()[i].name,
                        problem.variable_text(i, x[i]));
  }
  return text;
}

}  // namespace pleuel
