#include "optimization/phase_one.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "optimization/restoration.hpp"
#include "optimization/scaled_problem.hpp"
#include "optimization/starts.hpp"

namespace pleuel {

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

constexpr double box_weight = 30.0;
constexpr double regularization = 1e-4;
constexpr int most_iterations = 100;
/// Gradient, relative to that at d = 0, which is round-off.
constexpr double gradient_rounding = 1e-13;
/// Halvings of an interval of step lengths: down to round-off.
constexpr int most_halvings = 60;

class PiecewiseQuadratic {
 public:
  PiecewiseQuadratic(const LinearizedLimits& limits, const Eigen::VectorXd& down,
                     const Eigen::VectorXd& up)
      : limits_(limits), down_(down), up_(up) {}

  /// Half the gradient.
  Eigen::VectorXd gradient(const Eigen::VectorXd& d) const {
    return limits_.slopes.transpose() * violations(d) + box_weight * box_weight * beyond_box(d) +
           regularization * d;
  }

  /// −H⁻¹ g with half the second derivatives H of the piece at d.
  Eigen::VectorXd newton_step(const Eigen::VectorXd& d, const Eigen::VectorXd& gradient) const {
    const Eigen::VectorXd violated = violations(d), beyond = beyond_box(d);
    std::vector<Eigen::Index> rows;
    for (Eigen::Index k = 0; k < violated.size(); ++k) {
      if (violated[k] > 0.0) rows.push_back(k);
    }
    const Eigen::MatrixXd slopes = limits_.slopes(rows, Eigen::all);
    Eigen::MatrixXd second = slopes.transpose() * slopes;
    for (Eigen::Index i = 0; i < d.size(); ++i) {
      second(i, i) += regularization + (beyond[i] != 0.0 ? box_weight * box_weight : 0.0);
    }
    return -DenseLu(second).solve(gradient);
  }

  /// The length of p along which the function is least, at most 1: that of slope 0.
  double best_length(const Eigen::VectorXd& d, const Eigen::VectorXd& p) const {
    const Eigen::VectorXd begin = limits_.residuals + limits_.slopes * d;
    const Eigen::VectorXd change = limits_.slopes * p;
    const auto slope = [&](double length) {
      const Eigen::VectorXd end = d + length * p;
      return change.dot((begin + length * change).cwiseMax(0.0)) +
             p.dot(box_weight * box_weight * beyond_box(end) + regularization * end);
    };
    if (slope(1.0) <= 0.0) return 1.0;
    double lower = 0.0, upper = 1.0;
    for (int i = 0; i < most_halvings; ++i) {
      const double middle = 0.5 * (lower + upper);
      (slope(middle) > 0.0 ? upper : lower) = middle;
    }
    return lower;
  }

 private:
  Eigen::VectorXd violations(const Eigen::VectorXd& d) const {
    return (limits_.residuals + limits_.slopes * d).cwiseMax(0.0);
  }

  Eigen::VectorXd beyond_box(const Eigen::VectorXd& d) const {
    return (d - up_).cwiseMax(0.0) - (-down_ - d).cwiseMax(0.0);
  }

  const LinearizedLimits& limits_;
  const Eigen::VectorXd &down_, &up_;
};

}  // namespace

Eigen::VectorXd violation_step(const LinearizedLimits& limits, const Eigen::VectorXd& down,
                               const Eigen::VectorXd& up) {
  const PiecewiseQuadratic function(limits, down, up);
  Eigen::VectorXd d = Eigen::VectorXd::Zero(down.size());
  Eigen::VectorXd gradient = function.gradient(d);
  const double round_off = gradient_rounding * gradient.norm();
  for (int i = 0; i < most_iterations && gradient.norm() > round_off; ++i) {
    const Eigen::VectorXd p = function.newton_step(d, gradient);
    const double length = function.best_length(d, p);
    if (length == 0.0) break;
    d += length * p;
    gradient = function.gradient(d);
  }
  return d.cwiseMin(up).cwiseMax(-down);
}

}  // namespace pleuel
