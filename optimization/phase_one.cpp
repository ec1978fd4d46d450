#include "optimization/phase_one.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

/// Of z: violations below are small ones.
constexpr double least_violation_magnitude = 0.1;

}  // namespace

double damped_violation(double violation) {
  return violation > 0.0 ? std::log1p(violation) : violation;
}

double damped_violation_slope(double violation) {
  return violation > 0.0 ? 1.0 / (1.0 + violation) : 1.0;
}

PhaseOneProblem::PhaseOneProblem(Problem& problem, const std::vector<bool>& is_elastic,
                                 const Eigen::VectorXd& start, const Evaluation& at_start,
                                 const Eigen::VectorXd& magnitudes)
    : problem_(problem), variables_(problem.variables()), sides_(limit_sides(problem, magnitudes)) {
  double largest = 0.0;
  for (const LimitSide& side : sides_) {
    rows_.push_back({problem.constraints()[side.constraint].name, -infinity, 1.0});
    is_elastic_.push_back(is_elastic[side.constraint]);
    if (is_elastic_.back()) {
      largest = std::max(largest, damped_violation(side.violation(at_start.constraints)));
    }
  }
  set_start(variables_, within_bounds(problem, start));
  variables_.push_back(
      {"violation", largest, 0.0, infinity, std::max(least_violation_magnitude, largest)});
}

Evaluation PhaseOneProblem::evaluate(const Eigen::VectorXd& xz, Request request) {
  const Evaluation inner = problem_.evaluate(design_of(xz), request);
  const Eigen::Index last = xz.size() - 1;
  Evaluation evaluation;
  evaluation.objective = xz[last];
  evaluation.constraints.resize(sides_.size());
  const bool with_gradients = request == Request::values_and_gradients;
  if (with_gradients) {
    evaluation.objective_gradient = Eigen::VectorXd::Unit(xz.size(), last);
    evaluation.constraint_jacobian =
        Eigen::MatrixXd::Zero(evaluation.constraints.size(), xz.size());
  }
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const LimitSide& side = sides_[k];
    const Eigen::Index row = k;
    const double violation = side.violation(inner.constraints);
    evaluation.constraints[row] =
        1.0 + damped_violation(violation) - (is_elastic_[k] ? evaluation.objective : 0.0);
    if (!with_gradients) continue;
    const double slope = damped_violation_slope(violation) * side.sign / side.magnitude;
    evaluation.constraint_jacobian.row(row).head(last) =
        slope * inner.constraint_jacobian.row(side.constraint);
    if (is_elastic_[k]) evaluation.constraint_jacobian(row, last) = -1.0;
  }
  return evaluation;
}

namespace {

/// Designs between the bounds that are tried where all else fails, and how many of the best of them
/// a restoration begins at.
constexpr int samples = 8;
constexpr std::size_t best_samples = 2;
constexpr RestorationBudget sample_budget{12, 30};
constexpr unsigned seed = 20;
/// Parts of the way from the start to the middle of the bounds.
constexpr std::array<double, 4> parts_to_the_middle = {0.25, 0.5, 0.75, 1.0};

Eigen::VectorXd middle_of(const Problem& problem) {
  Eigen::VectorXd middle = start_of(problem);
  for (Eigen::Index i = 0; i < middle.size(); ++i) {
    const Variable& variable = problem.variables()[i];
    const double centre = 0.5 * (variable.lower + variable.upper);
    if (std::isfinite(centre)) middle[i] = centre;
  }
  return middle;
}

std::vector<Eigen::VectorXd> samples_that_break_least(const LimitRows& rows, const Problem& limits,
                                                      const Eigen::VectorXd& magnitudes) {
  std::vector<std::pair<double, Eigen::VectorXd>> rated;
  for (Eigen::VectorXd& x : latin_hypercube(limits.variables(), samples, seed)) {
    const Attempt attempt = attempt_evaluation(*rows.problem, x, Request::values);
    if (!attempt.evaluation) continue;
    const Eigen::VectorXd values =
        worst_values(rows.constraint_of_row, attempt.evaluation->constraints, limits.constraints());
    rated.emplace_back(max_violation(limits, values, magnitudes), std::move(x));
  }
  std::ranges::stable_sort(rated, {}, [](const auto& one) { return one.first; });
  std::vector<Eigen::VectorXd> designs;
  for (std::size_t i = 0; i < std::min(best_samples, rated.size()); ++i) {
    designs.push_back(std::move(rated[i].second));
  }
  return designs;
}

}  // namespace

ConstraintOfRow own_constraints(const Problem& problem) {
  ConstraintOfRow rows;
  for (std::size_t i = 0; i < problem.constraints().size(); ++i) rows.emplace_back(i);
  return rows;
}

Eigen::VectorXd worst_values(const ConstraintOfRow& constraint_of_row, const Eigen::VectorXd& rows,
                             const std::vector<Constraint>& limits) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(limits.size());
  std::vector<bool> is_set(limits.size(), false);
  for (std::size_t row = 0; row < constraint_of_row.size(); ++row) {
    if (!constraint_of_row[row]) continue;
    const std::size_t i = *constraint_of_row[row];
    const double value = rows[row];
    if (!is_set[i] || limits[i].excess(value) > limits[i].excess(values[i])) values[i] = value;
    is_set[i] = true;
  }
  return values;
}

std::optional<Eigen::VectorXd> evaluable_design(Problem& problem) {
  const Eigen::VectorXd start = start_of(problem);
  const Eigen::VectorXd middle = middle_of(problem);
  std::vector<Eigen::VectorXd> designs;
  for (const double part : parts_to_the_middle) designs.push_back(start + part * (middle - start));
  for (Eigen::VectorXd& x : latin_hypercube(problem.variables(), samples, seed)) {
    designs.push_back(std::move(x));
  }
  for (const Eigen::VectorXd& x : designs) {
    if (attempt_evaluation(problem, x, Request::values_and_gradients).evaluation) return x;
  }
  return std::nullopt;
}

std::optional<Eigen::VectorXd> design_within_limits(const LimitRows& rows, const Problem& limits,
                                                    const Eigen::VectorXd& magnitudes,
                                                    const Eigen::VectorXd& best) {
  if (auto inside = restore_limits(*rows.problem, best)) return inside;
  for (const Eigen::VectorXd& x : samples_that_break_least(rows, limits, magnitudes)) {
    if (auto inside = restore_limits(*rows.problem, x, sample_budget)) return inside;
  }
  return std::nullopt;
}

}  // namespace pleuel
