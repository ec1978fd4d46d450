#include "optimization/phase_one_problem.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace pleuel
