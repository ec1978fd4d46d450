#include "optimization/problem.hpp"

#include <algorithm>
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

}  // namespace

std::string Problem::variable_text(std::size_t, double value) const {
  return fmt::format("{:.6g}", value);
}

std::string Problem::constraint_text(std::size_t, double value) const {
  return fmt::format("{:.6g}", value);
}

FunctionProblem::FunctionProblem(std::vector<Variable> variables,
                                 std::vector<Constraint> constraints, Function function)
    : variables_(std::move(variables)),
      constraints_(std::move(constraints)),
      function_(std::move(function)) {}

Evaluation FunctionProblem::evaluate(const Eigen::VectorXd& x, Request request) {
  return function_(x, request);
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

std::string describe_design(const Problem& problem, const Eigen::VectorXd& x) {
  std::string text;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    text += fmt::format("{}{} = {}", i == 0 ? "" : ", ", problem.variables()[i].name,
                        problem.variable_text(i, x[i]));
  }
  return text;
}

}  // namespace pleuel
