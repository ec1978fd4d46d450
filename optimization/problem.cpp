#include "optimization/problem.hpp"

#include <cassert>
#include <cmath>
#include <numeric>

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

namespace {

constexpr double reach_without_bounds = 10.0;

std::pair<double, double> range_of(const Variable& variable) {
  double lower = variable.lower, upper = variable.upper;
  if (variable.has_lower() && variable.has_upper()) return {lower, upper};
  const double reach =
      reach_without_bounds * std::max(std::abs(variable.start), variable.magnitude);
  if (reach == 0.0) {
    throw InputError(fmt::format(
        "/variables/{} has no bounds and starts at 0: nothing says where other starts may lie",
        variable.name));
  }
  if (!variable.has_lower()) lower = variable.start - reach;
  if (!variable.has_upper()) upper = variable.start + reach;
  return {lower, upper};
}

/// In [0, 1); distributions of the standard library differ between its makers.
double uniform(std::mt19937& engine) {
  return static_cast<double>(engine()) / 4294967296.0;
}

std::vector<int> shuffled(int count, std::mt19937& engine) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  for (int i = count - 1; i > 0; --i) {
    std::swap(order[i], order[static_cast<std::size_t>(uniform(engine) * (i + 1))]);
  }
  return order;
}

}  // namespace

std::vector<Eigen::VectorXd> latin_hypercube(const std::vector<Variable>& variables, int count,
                                             unsigned seed) {
  std::mt19937 engine(seed);
  const Eigen::Index n = variables.size();
  std::vector<Eigen::VectorXd> designs(count, Eigen::VectorXd(n));
  for (Eigen::Index i = 0; i < n; ++i) {
    const Variable& variable = variables[i];
    const auto [lower, upper] = range_of(variable);
    const std::vector<int> parts = shuffled(count, engine);
    for (std::size_t k = 0; k < designs.size(); ++k) {
      const double share = (parts[k] + uniform(engine)) / count;
      designs[k][i] = std::clamp(std::lerp(lower, upper, share), variable.lower, variable.upper);
    }
  }
  return designs;
}

}  // namespace pleuel
